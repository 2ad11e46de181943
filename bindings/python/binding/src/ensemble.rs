//! Ensembles as Python sees them: what is given, how it is watched, what is returned.

use core::any::Any;
use core::sync::atomic::{AtomicU64, Ordering};
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;

use dalembert_ensemble::parts::{self, PartsError};
use dalembert_face::Number;
use numpy::{PyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyModule};

use crate::arguments::{self, array, expected, input, of_shape, time};
use crate::arrays::to_array;
use crate::crossings::Crossings;
use crate::error::{of_member, of_memory, of_refusal};
use crate::events::Event;
use crate::given_fields::entries_of_members;
use crate::many::{Asked, Control, FieldOfMembers, FoundOfMembers, Kept, NoResult, Rows, Written};
use crate::model::{Kind, Model};
use crate::offer::Stepping;
use crate::pickled::{Reduced, reduced};
use crate::pool;
use crate::starts::either;
use crate::watch::PATIENCE;
use crate::watching::Raised;

/// The states of all members, one row each.
#[pyclass(frozen, get_all)]
pub struct Ends {
    /// Times, shape (members,), or (members, records).
    t: Py<PyArrayDyn<f64>>,
    /// Configurations, shape (members, n), or (members, records, n).
    q: Py<PyArrayDyn<f64>>,
    /// Velocities, of the shape of q.
    v: Py<PyArrayDyn<f64>>,
    /// Momenta, of the shape of q.
    p: Py<PyArrayDyn<f64>>,
    /// Energies, of the shape of t.
    energy: Py<PyArrayDyn<f64>>,
    /// The events of each function that was given, member by member.
    events: Vec<Py<Crossings>>,
    /// Why members are not what was asked for, by their numbers: exceptions that were not raised. Their rows are NaN.
    failures: Py<PyDict>,
}

#[pymethods]
impl Ends {
    #[staticmethod]
    fn _restored(
        t: Py<PyArrayDyn<f64>>,
        q: Py<PyArrayDyn<f64>>,
        v: Py<PyArrayDyn<f64>>,
        p: Py<PyArrayDyn<f64>>,
        energy: Py<PyArrayDyn<f64>>,
        events: Vec<Py<Crossings>>,
        failures: Py<PyDict>,
    ) -> Self {
        Self { t, q, v, p, energy, events, failures }
    }

    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(this, &["t", "q", "v", "p", "energy", "events", "failures"])
    }

    fn __len__(&self, py: Python<'_>) -> usize {
        self.t.bind(py).shape()[0]
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        format!("Ends: {} members, {} failed", self.__len__(py), self.failures.bind(py).len())
    }
}

/// What was written as Parquet files, one for each part of the members.
#[pyclass(frozen, get_all)]
pub struct Parts {
    /// Parts that were computed and written.
    written: u64,
    /// Parts that were there.
    found: u64,
    /// Members that failed, of parts written and found.
    failed: u64,
    /// Members among them of parts that were there.
    failed_before: u64,
    /// Files of these parts that another call writes, or may be writing on another host, left alone.
    spared: u64,
    /// The files, in order.
    paths: Vec<PathBuf>,
}

#[pymethods]
impl Parts {
    #[staticmethod]
    fn _restored(
        written: u64,
        found: u64,
        failed: u64,
        failed_before: u64,
        spared: u64,
        paths: Vec<PathBuf>,
    ) -> Self {
        Self { written, found, failed, failed_before, spared, paths }
    }

    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(this, &["written", "found", "failed", "failed_before", "spared", "paths"])
    }

    fn __len__(&self) -> usize {
        self.paths.len()
    }

    fn __repr__(&self) -> String {
        let Self { written, found, failed, failed_before, spared, .. } = *self;
        format!("Parts: {}", parts::Written { written, found, failed, failed_before, spared })
    }
}

/// The arguments of `ensemble`.
pub struct Given<'a, 'py> {
    /// Configurations.
    pub q: &'a Bound<'py, PyAny>,
    /// Velocities.
    pub v: Option<&'a Bound<'py, PyAny>>,
    /// Momenta.
    pub p: Option<&'a Bound<'py, PyAny>>,
    /// Inputs.
    pub u: Option<&'a Bound<'py, PyAny>>,
    /// The time.
    pub t: Option<f64>,
    /// Fields that differ.
    pub fields: Option<&'a Bound<'py, PyAny>>,
    /// The number of the first member.
    pub first: u64,
    /// The steps.
    pub stepping: Stepping<'a>,
    /// Steps from one record to the next.
    pub every: Option<u64>,
    /// Events to look for in the run of each.
    pub events: &'a [Event<'a>],
    /// The exception that an event function has raised.
    pub raised: &'a Raised,
    /// Where parts go, and their size.
    pub parts: Option<(PathBuf, u64)>,
    /// Threads; those of the machine unless said.
    pub threads: Option<usize>,
    /// The callable that is told how many members are done.
    pub progress: Option<Py<PyAny>>,
}

/// Numbers for each member, or for all: the rows, and how many there are if it is one for each.
#[derive(Default)]
struct Read {
    numbers: Vec<f64>,
    members: Option<usize>,
    width: usize,
}

fn read(name: &str, given: &Bound<'_, PyAny>, width: usize) -> PyResult<Read> {
    let array = array(name, given)?;
    let members = match *array.shape() {
        [columns] if columns == width => None,
        [rows, columns] if columns == width => Some(rows),
        _ => return Err(of_shape(name, &format!("({width},) or (members, {width})"), array.shape())),
    };
    Ok(Read { numbers: arguments::numbers(&array), members, width })
}

impl Read {
    fn rows(&self) -> Rows<'_> {
        Rows { numbers: &self.numbers, width: self.width }
    }
}

/// The result of an ensemble: the states kept, or the files written.
enum Results {
    Arrays(Kept),
    Files(Written),
}

/// Runs the ensemble.
///
/// # Errors
/// Exceptions of all kinds.
pub fn run<'py>(py: Python<'py>, model: &dyn Model, given: Given<'_, 'py>) -> PyResult<Bound<'py, PyAny>> {
    let kind = model.kind();
    let n = kind.coordinates();
    let (name, other, is_velocity) = either(given.v, given.p)?;
    let (q, other) = (read("q", given.q, n)?, read(name, other, n)?);
    let inputs = input(kind, given.u, |u, length| read("u", u, length))?.unwrap_or_default();
    let time = time(kind, given.t)?;
    let mut members = None;
    for (name, length) in [("q", q.members), (name, other.members), ("u", inputs.members)] {
        agree(&mut members, name, length)?;
    }
    let fields = fields(model, given.fields, &mut members)?;
    let members = members.ok_or_else(|| {
        PyValueError::new_err(
            "members: expected a row for each in q, v, p, u or a field; got one row for all",
        )
    })?;
    let asked = Asked {
        members,
        first: given.first,
        q: q.rows(),
        other: other.rows(),
        is_velocity,
        inputs: inputs.rows(),
        time,
        fields: &fields,
        stepping: given.stepping,
        every: given.every,
        events: given.events,
    };
    let pool = pool::of(py, given.threads)?;
    let control = Control { cancel: given.raised.cancel(), done: AtomicU64::new(0) };
    let parts = given.parts.as_ref();
    let work = || match parts {
        Some((folder, size)) => model.written(&asked, &control, folder, *size).map(Results::Files),
        None => model.kept(&asked, &control).map(Results::Arrays),
    };
    let look = |py: Python<'_>| {
        py.check_signals()?;
        given.raised.take().map_or(Ok(()), Err)?;
        let done = control.done.load(Ordering::Relaxed);
        given.progress.as_ref().map_or(Ok(()), |progress| progress.call1(py, (done, members)).map(drop))
    };
    let result = followed(py, &control, &look, &|| pool.install(work))?;
    let rule = match given.stepping {
        Stepping::Fixed { rule, .. } => rule,
        Stepping::ToError(_) => None,
    };
    match result.map_err(|reason| of_no_result(py, reason, rule, kind))? {
        Results::Arrays(kept) => {
            Ok(Py::new(py, ends(py, kept, members, n, given.every.is_some())?)?.into_bound(py).into_any())
        }
        Results::Files(Written { counts, paths }) => {
            let parts::Written { written, found, failed, failed_before, spared } = counts;
            let parts = Parts { written, found, failed, failed_before, spared, paths };
            Ok(Py::new(py, parts)?.into_bound(py).into_any())
        }
    }
}

fn agree(members: &mut Option<usize>, name: &str, length: Option<usize>) -> PyResult<()> {
    match (*members, length) {
        (Some(members), Some(length)) if members != length => Err(PyValueError::new_err(format!(
            "{name}: expected a row for each of {members} members, got {length} rows"
        ))),
        (None, Some(length)) => {
            *members = Some(length);
            Ok(())
        }
        _ => Ok(()),
    }
}

fn fields(
    model: &dyn Model,
    given: Option<&Bound<'_, PyAny>>,
    members: &mut Option<usize>,
) -> PyResult<Vec<FieldOfMembers>> {
    let kind = model.kind();
    let mut fields = Vec::new();
    let dict =
        |given| Bound::cast::<PyDict>(given).map_err(|_| expected("fields", "a dict of arrays", given));
    for (name, value) in given.map(dict).transpose()?.into_iter().flatten() {
        let name: String = name.extract()?;
        let Some(field) = kind.fields().iter().position(|field| field.name == name) else {
            let all: Vec<&str> = kind.fields().iter().map(|field| field.name).collect();
            return Err(PyTypeError::new_err(format!(
                "{} has no field {name}; it has {}",
                kind.name(),
                all.join(", ")
            )));
        };
        let like = model.entry(field, 0).unwrap_or(Number::F64(0.0));
        let (numbers, length) = entries_of_members(&kind.fields()[field], like, &value)?;
        agree(members, &name, Some(length))?;
        if kind.fields()[field].is_table {
            // What has no error here has none where the members are made.
            let mut tried = model.copy();
            for numbers in numbers.chunks(numbers.len() / length.max(1)) {
                let changed = tried.change_field(field, numbers);
                changed.map_err(|wrong| PyValueError::new_err(wrong.to_string()))?;
            }
        }
        fields.push((field, numbers));
    }
    Ok(fields)
}

/// Runs `work` on a thread of its own, while this one asks `look` from time to time whether to go on.
fn followed<T: Send>(
    py: Python<'_>,
    control: &Control<'_>,
    look: &(dyn Fn(Python<'_>) -> PyResult<()> + Sync),
    work: &(dyn Fn() -> T + Sync),
) -> PyResult<T> {
    let look = || Python::attach(look);
    py.detach(|| {
        thread::scope(|scope| {
            let (send, receive) = sync_channel(1);
            // The receiver is there until the result is.
            scope.spawn(move || drop(send.send(catch_unwind(AssertUnwindSafe(work)))));
            let mut interruption = None;
            loop {
                match receive.recv_timeout(PATIENCE) {
                    Ok(Err(panic)) => return Err(of_panic(&*panic)),
                    Ok(Ok(result)) => {
                        return match interruption.or_else(|| look().err()) {
                            None => Ok(result),
                            Some(error) => Err(error),
                        };
                    }
                    Err(RecvTimeoutError::Timeout) => {
                        if interruption.is_none()
                            && let Err(error) = look()
                        {
                            control.cancel.store(true, Ordering::Relaxed);
                            interruption = Some(error);
                        }
                    }
                    Err(RecvTimeoutError::Disconnected) => {
                        return Err(PyRuntimeError::new_err("the ensemble has no result"));
                    }
                }
            }
        })
    })
}

/// The exception of what panicked beside the members.
fn of_panic(panic: &(dyn Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
    PyRuntimeError::new_err(format!("the ensemble panicked: {}", text.unwrap_or("without a word")))
}

fn ends(py: Python<'_>, kept: Kept, members: usize, n: usize, has_records: bool) -> PyResult<Ends> {
    let Kept { t, q, v, p, energy, failures, records, events } = kept;
    let shape = |last: &[usize]| {
        let records: &[usize] = if has_records { &[records] } else { &[] };
        [&[members], records, last].concat()
    };
    let array = |numbers: Vec<f64>, last: &[usize]| to_array(py, numbers, shape(last)).map(Bound::unbind);
    let by_number = PyDict::new(py);
    for failed in failures {
        by_number.set_item(failed.number, of_member(py, &failed)?)?;
    }
    let events = events
        .into_iter()
        .map(|FoundOfMembers { members, found }| Py::new(py, Crossings::new(py, found, Some(members), n)?));
    Ok(Ends {
        events: events.collect::<PyResult<_>>()?,
        t: array(t, &[])?,
        q: array(q, &[n])?,
        v: array(v, &[n])?,
        p: array(p, &[n])?,
        energy: array(energy, &[])?,
        failures: by_number.unbind(),
    })
}

fn of_no_result(py: Python<'_>, reason: NoResult, rule: Option<&str>, kind: &dyn Kind) -> PyErr {
    match reason {
        NoResult::Refused(refusal) => of_refusal(py, refusal, rule, &kind.rules()),
        NoResult::Cancelled => PyValueError::new_err("cancelled"),
        NoResult::TooLarge(reason) => of_memory(&reason),
        NoResult::Parts(PartsError::Io { path, source }) => of_files(path, &source),
        NoResult::Parts(error) => PyValueError::new_err(error.to_string()),
    }
}

/// The exception of a file, of the class that Python has for its number.
fn of_files(path: PathBuf, source: &io::Error) -> PyErr {
    let text = source.to_string();
    match source.raw_os_error() {
        Some(number) => {
            let text = text.trim_end_matches(&format!(" (os error {number})"));
            PyOSError::new_err((number, text.to_owned(), path.into_os_string()))
        }
        None => PyOSError::new_err(format!("{}: {text}", path.display())),
    }
}

/// Adds the classes to `module`, as its own.
///
/// # Errors
/// Those of Python.
pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Ends>()?;
    module.add_class::<Parts>()?;
    for name in ["Ends", "Parts"] {
        module.getattr(name)?.setattr("__module__", module.name()?)?;
    }
    Ok(())
}
