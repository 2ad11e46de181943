//! Results: arrays, and objects that print.

use std::ffi::CString;

use dalembert::tolerance::Breach as BreachOf;
use numpy::{PyArray1, PyArray2, PyArray3};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyModule};

use crate::arrays::to_array;
use crate::crossings::Crossings;
use crate::linearization::Linearization;
use crate::model::Ran;
use crate::pickled::{Reduced, reduced};
use crate::record::Record;

/// Where the error expected of a run has passed the tolerance.
#[pyclass(frozen, get_all)]
pub struct Breach {
    /// The time.
    t: f64,
    /// The error expected of the state there.
    expected: f64,
    /// The tolerance.
    tolerance: f64,
    /// A tolerance to ask for instead, from the start.
    instead: f64,
}

#[pymethods]
impl Breach {
    #[staticmethod]
    fn _restored(t: f64, expected: f64, tolerance: f64, instead: f64) -> Self {
        Self { t, expected, tolerance, instead }
    }

    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(this, &["t", "expected", "tolerance", "instead"])
    }

    fn __repr__(&self) -> String {
        let Self { t, expected, tolerance, instead } = self;
        format!("Breach(t={t:?}, expected={expected:e}, tolerance={tolerance:e}, instead={instead:e})")
    }
}

/// The records of a run.
///
/// One row a record: the start, every `every`-th step and the last one.
#[pyclass(frozen, get_all)]
pub struct Run {
    /// Times, shape (records,).
    t: Py<PyArray1<f64>>,
    /// Configurations, shape (records, n).
    q: Py<PyArray2<f64>>,
    /// Velocities, shape (records, n).
    v: Py<PyArray2<f64>>,
    /// Momenta, shape (records, n).
    p: Py<PyArray2<f64>>,
    /// Energies v·∂L/∂v − L, shape (records,).
    energy: Py<PyArray1<f64>>,
    /// ∂(q, p)/∂(q0, p0), shape (records, 2n, 2n); None unless `derivatives=True`.
    by_start: Option<Py<PyArray3<f64>>>,
    /// ∂(q, p)/∂θ with (q0, p0) held, shape (records, 2n, parameters); None unless `derivatives=True`.
    by_parameters: Option<Py<PyArray3<f64>>>,
    /// λ of the constraints over the step that led there, at the start over the first, shape (records,
    /// constraints): the force is Gᵀλ, G their derivatives by q; None unless `reactions=True`.
    reactions: Option<Py<PyArray2<f64>>>,
    /// Steps taken.
    steps: u64,
    /// Iterations of the solver, all steps together.
    iterations: u64,
    /// The step size.
    h: f64,
    /// The rule, or the method chosen for the tolerance.
    rule: String,
    /// The error expected at the end of a run to a tolerance; None of others.
    expected: Option<f64>,
    /// Where the error expected has passed the tolerance; None where it has not.
    breach: Option<Py<Breach>>,
    /// The events of each function that was given.
    events: Vec<Py<Crossings>>,
}

/// The arrays of a record.
struct Arrays<'py> {
    t: Bound<'py, PyArray1<f64>>,
    q: Bound<'py, PyArray2<f64>>,
    v: Bound<'py, PyArray2<f64>>,
    p: Bound<'py, PyArray2<f64>>,
    energy: Bound<'py, PyArray1<f64>>,
}

impl<'py> Arrays<'py> {
    fn new(py: Python<'py>, record: &mut Record, n: usize) -> PyResult<Self> {
        let records = record.t.len();
        let vectors = |numbers: &mut Vec<f64>| to_array(py, core::mem::take(numbers), [records, n]);
        Ok(Self {
            q: vectors(&mut record.q)?,
            v: vectors(&mut record.v)?,
            p: vectors(&mut record.p)?,
            t: to_array(py, core::mem::take(&mut record.t), [records])?,
            energy: to_array(py, core::mem::take(&mut record.energy), [records])?,
        })
    }
}

/// λ of the records, where it was asked for.
fn reactions<'py>(py: Python<'py>, record: &mut Record) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
    let (numbers, records) = (core::mem::take(&mut record.reactions), record.t.len());
    let columns = numbers.len() / records.max(1);
    (!numbers.is_empty()).then(|| to_array(py, numbers, [records, columns])).transpose()
}

impl Run {
    /// The run of a system with `n` coordinates, from the time `origin` on.
    ///
    /// # Errors
    /// Those of Python.
    pub fn new(
        py: Python<'_>,
        ran: Ran,
        origin: f64,
        n: usize,
        parameters: usize,
        h: f64,
        rule: &str,
    ) -> PyResult<Self> {
        let Ran { mut record, guarded, .. } = ran;
        let events = core::mem::take(&mut record.events)
            .into_iter()
            .map(|found| Py::new(py, Crossings::new(py, found, None, n)?));
        let records = record.t.len();
        let matrices = |numbers: Vec<f64>, columns: usize| -> PyResult<Option<Py<PyArray3<f64>>>> {
            let has_any = !numbers.is_empty();
            let array = || to_array(py, numbers, [records, 2 * n, columns]).map(Bound::unbind);
            has_any.then(array).transpose()
        };
        let by_start = matrices(core::mem::take(&mut record.by_start), 2 * n)?;
        let by_parameters = matrices(core::mem::take(&mut record.by_parameters), parameters)?;
        let reactions = reactions(py, &mut record)?.map(Bound::unbind);
        let breach = guarded.as_ref().and_then(|guarded| guarded.breach);
        let breach = breach.map(|BreachOf { time, expected, tolerance, instead, .. }| {
            Py::new(py, Breach { t: origin + time, expected, tolerance, instead })
        });
        let Arrays { t, q, v, p, energy } = Arrays::new(py, &mut record, n)?;
        Ok(Self {
            t: t.unbind(),
            q: q.unbind(),
            v: v.unbind(),
            p: p.unbind(),
            energy: energy.unbind(),
            by_start,
            by_parameters,
            reactions,
            steps: record.steps,
            iterations: record.iterations,
            h: guarded.as_ref().map_or(h, |guarded| guarded.h),
            rule: guarded.as_ref().map_or_else(|| rule.to_owned(), |guarded| guarded.method.clone()),
            expected: guarded.as_ref().map(|guarded| guarded.expected),
            breach: breach.transpose()?,
            events: events.collect::<PyResult<_>>()?,
        })
    }
}

impl Run {
    /// The warning that the error expected has passed the tolerance, where it has.
    #[must_use]
    pub fn breach_text(&self) -> Option<String> {
        let Breach { t, expected, tolerance, instead } = self.breach.as_ref()?.get();
        Some(format!(
            "the error expected passed the {tolerance:e} asked for at t = {t}: {expected:e}; ask for {instead:e} from the start"
        ))
    }
}

/// The records of a run that failed, as a dict.
///
/// # Errors
/// Those of Python.
pub fn partial<'py>(py: Python<'py>, record: &mut Record, n: usize) -> PyResult<Bound<'py, PyDict>> {
    let reactions = reactions(py, record)?;
    let Arrays { t, q, v, p, energy } = Arrays::new(py, record, n)?;
    let partial = PyDict::new(py);
    if let Some(reactions) = reactions {
        partial.set_item("reactions", reactions)?;
    }
    partial.set_item("t", t)?;
    partial.set_item("q", q)?;
    partial.set_item("v", v)?;
    partial.set_item("p", p)?;
    partial.set_item("energy", energy)?;
    Ok(partial)
}

#[pymethods]
impl Run {
    #[staticmethod]
    #[allow(clippy::too_many_arguments, reason = "all attributes")]
    fn _restored(
        t: Py<PyArray1<f64>>,
        q: Py<PyArray2<f64>>,
        v: Py<PyArray2<f64>>,
        p: Py<PyArray2<f64>>,
        energy: Py<PyArray1<f64>>,
        by_start: Option<Py<PyArray3<f64>>>,
        by_parameters: Option<Py<PyArray3<f64>>>,
        reactions: Option<Py<PyArray2<f64>>>,
        steps: u64,
        iterations: u64,
        h: f64,
        rule: String,
        expected: Option<f64>,
        breach: Option<Py<Breach>>,
        events: Vec<Py<Crossings>>,
    ) -> Self {
        Self {
            t,
            q,
            v,
            p,
            energy,
            by_start,
            by_parameters,
            reactions,
            steps,
            iterations,
            h,
            rule,
            expected,
            breach,
            events,
        }
    }

    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        let of_records = ["t", "q", "v", "p", "energy", "by_start", "by_parameters", "reactions"];
        let of_run = ["steps", "iterations", "h", "rule", "expected", "breach", "events"];
        reduced(this, &[&of_records[..], &of_run].concat())
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.t.bind(py).len()
    }

    /// A pandas DataFrame with a row for each record and t as its index: columns q0 …, v0 …, p0 …, energy,
    /// and reaction0 … where there are reactions.
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     pandas is not installed.
    fn to_pandas<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        in_python(this, "to_pandas")
    }

    /// An xarray Dataset with the coordinate t: q, v, p by (t, coordinate), energy by t, and the derivatives
    /// and reactions that there are.
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     xarray is not installed.
    fn to_xarray<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        in_python(this, "to_xarray")
    }

    /// A figure of matplotlib: q above, the energy below.
    ///
    /// Raises
    /// ------
    /// ImportError
    ///     matplotlib is not installed.
    fn plot<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        in_python(this, "plot")
    }

    fn __repr__<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        in_python(this, "shown")
    }
}

/// The result of a function of `run.py`.
fn in_python<'py>(run: &Bound<'py, Run>, function: &str) -> PyResult<Bound<'py, PyAny>> {
    static FUNCTIONS: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let py = run.py();
    let text =
        || PyModule::from_code(py, &CString::new(include_str!("run.py"))?, c"run.py", c"_dalembert_run");
    let functions = FUNCTIONS.get_or_try_init(py, || PyResult::Ok(text()?.unbind()))?;
    functions.bind(py).call_method1(function, (run,))
}

/// Adds the classes of results to `module`, as its own.
///
/// # Errors
/// Those of Python.
pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Run>()?;
    module.add_class::<Linearization>()?;
    module.add_class::<Breach>()?;
    module.add_class::<Crossings>()?;
    for name in ["Run", "Linearization", "Breach", "Crossings"] {
        module.getattr(name)?.setattr("__module__", module.name()?)?;
    }
    Ok(())
}
