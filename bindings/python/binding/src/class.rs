//! The class of a system in Python, and what its methods do.

use std::path::PathBuf;
use std::sync::{PoisonError, RwLock};

use numpy::{PyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::{PyAttributeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::arguments::{self, array, entries, input, number, rows, time, vector};
use crate::arrays::to_array;
use crate::checks::{Affine, Region};
use crate::ensemble;
use crate::error::{of_events, of_memory, of_refusal, of_step, warn};
use crate::linearization::Linearization;
use crate::model::{Kind, Model, MotionGiven, Run as Asked, Start};
use crate::motion::{self, Along};
use crate::offer::{ErrorAsked, Stepping};
use crate::record::Stop;
use crate::reports::{EnergyLedger, Symmetry};
use crate::results::{Run, partial};
use crate::watch::{Watch, watched};
use crate::watching::{self, Raised};

/// Under which name a class has its [`KindObject`].
pub const KIND: &str = "_kind";

/// The kind of the systems of a class.
#[pyclass(frozen, name = "_Kind")]
pub struct KindObject(pub &'static dyn Kind);

/// A system with its fields: what all systems of this module have in common.
#[pyclass(frozen, subclass)]
pub struct System {
    model: RwLock<Box<dyn Model>>,
}

impl System {
    /// The system as it is now, which runs go on with while fields change.
    fn model(&self) -> Box<dyn Model> {
        self.model.read().unwrap_or_else(PoisonError::into_inner).copy()
    }

    /// The value of a field: a number, or an array that cannot be written into.
    ///
    /// # Errors
    /// Those of Python.
    pub fn field<'py>(&self, py: Python<'py>, field: usize) -> PyResult<Bound<'py, PyAny>> {
        let model = self.model();
        let about = &model.kind().fields()[field];
        let numbers = (0..).map_while(|index| model.entry(field, index));
        if about.dimensions.is_empty() {
            let mut numbers = numbers;
            let first = numbers.next().ok_or_else(|| PyAttributeError::new_err(about.name))?;
            return number(py, first);
        }
        let numbers = numbers.map(|entry| number(py, entry)).collect::<PyResult<Vec<_>>>()?;
        let array = py.import("numpy")?.call_method1("array", (numbers,))?;
        let array = array.call_method1("reshape", (about.dimensions.to_vec(),))?;
        let keywords = PyDict::new(py);
        keywords.set_item("write", false)?;
        array.call_method("setflags", (), Some(&keywords))?;
        Ok(array)
    }

    /// Gives a field another value.
    ///
    /// # Errors
    /// Those of a value that the field does not hold; the field is then as before.
    pub fn change_field(&self, field: usize, value: &Bound<'_, PyAny>) -> PyResult<()> {
        let model = self.model();
        let about = &model.kind().fields()[field];
        let like = model.entry(field, 0).ok_or_else(|| PyAttributeError::new_err(about.name))?;
        let entries = entries(about, like, value)?;
        let mut model = self.model.write().unwrap_or_else(PoisonError::into_inner);
        for (index, entry) in entries.into_iter().enumerate() {
            model.change_entry(field, index, entry);
        }
        Ok(())
    }

    /// The values of all fields.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let fields = self.model().kind().fields().len();
        (0..fields).map(|field| self.field(py, field)).collect()
    }
}

/// The configuration and velocity or momentum of a start, and the inputs.
struct Given {
    q: Vec<f64>,
    other: Vec<f64>,
    is_velocity: bool,
    inputs: Vec<f64>,
    time: f64,
}

impl Given {
    fn start(&self) -> Start<'_> {
        let motion = if self.is_velocity {
            MotionGiven::Velocity(&self.other)
        } else {
            MotionGiven::Momentum(&self.other)
        };
        Start { q: &self.q, motion, inputs: &self.inputs, time: self.time }
    }
}

/// The arguments of a method of a system that say where it starts.
struct StartArguments<'a, 'py> {
    q: &'a Bound<'py, PyAny>,
    v: Option<&'a Bound<'py, PyAny>>,
    p: Option<&'a Bound<'py, PyAny>>,
    u: Option<&'a Bound<'py, PyAny>>,
    t: Option<f64>,
    /// For how many steps there may be inputs.
    steps: u64,
}

impl StartArguments<'_, '_> {
    fn read(&self, kind: &dyn Kind) -> PyResult<Given> {
        let n = kind.coordinates();
        let (name, given, is_velocity) = match (self.v, self.p) {
            (Some(v), None) => ("v", v, true),
            (None, Some(p)) => ("p", p, false),
            _ => return Err(PyTypeError::new_err("a start is q with either v or p")),
        };
        let (inputs, time) = inputs(kind, self.u, self.t, self.steps)?;
        Ok(Given { q: vector("q", self.q, n)?, other: vector(name, given, n)?, is_velocity, inputs, time })
    }
}

/// The inputs, for so many steps at most, and the time, as far as the system takes them.
fn inputs(
    kind: &dyn Kind,
    u: Option<&Bound<'_, PyAny>>,
    t: Option<f64>,
    steps: u64,
) -> PyResult<(Vec<f64>, f64)> {
    Ok((input(kind, u, |u, length| rows("u", u, steps, length))?.unwrap_or_default(), time(kind, t)?))
}

/// The times of states, one for all or one for each, of arrays of this shape; of a system that takes none, 0.
fn times(kind: &dyn Kind, t: Option<&Bound<'_, PyAny>>, shape: &[usize]) -> PyResult<Vec<f64>> {
    let Some(t) = t else {
        return match kind.takes_time() {
            false => Ok(vec![0.0]),
            true => Err(PyTypeError::new_err(format!(
                "{} takes the time: give t, that of the state or of each, as the t of its run",
                kind.name()
            ))),
        };
    };
    // A system that takes none says so, whatever is given.
    time(kind, Some(0.0))?;
    let given = array("t", t)?;
    if !given.shape().is_empty() && given.shape() != shape {
        let states: Vec<String> = shape.iter().map(usize::to_string).collect();
        let expected = format!("one for all, or one for each state, ({})", states.join(", "));
        return Err(arguments::of_shape("t", &expected, given.shape()));
    }
    let times = arguments::numbers(&given);
    times.iter().try_for_each(|&t| time(kind, Some(t)).map(drop))?;
    Ok(times)
}

/// q and v, as arrays of one shape.
type Pair<'py> = (Bound<'py, PyArrayDyn<f64>>, Bound<'py, PyArrayDyn<f64>>);

/// States, one after the other.
struct States {
    /// Their times, or that of all.
    times: Vec<f64>,
    q: Vec<f64>,
    /// Velocities or momenta.
    other: Vec<f64>,
    /// The shape of the array in which they are given.
    shape: Vec<usize>,
}

/// The states that are given as arrays whose last dimension is n.
fn states(
    kind: &dyn Kind,
    q: &Bound<'_, PyAny>,
    (name, other): (&str, &Bound<'_, PyAny>),
    t: Option<&Bound<'_, PyAny>>,
) -> PyResult<States> {
    let n = kind.coordinates();
    let (q, other) = (array("q", q)?, array(name, other)?);
    if q.shape().last() != Some(&n) {
        return Err(arguments::of_shape("q", &format!("(…, {n})"), q.shape()));
    }
    if q.shape() != other.shape() {
        let shape: Vec<String> = q.shape().iter().map(usize::to_string).collect();
        return Err(arguments::of_shape(name, &format!("of q, ({})", shape.join(", ")), other.shape()));
    }
    let shape = q.shape()[..q.ndim() - 1].to_vec();
    let times = times(kind, t, &shape)?;
    Ok(States { times, q: arguments::numbers(&q), other: arguments::numbers(&other), shape })
}

/// Translations along each coordinate, and rotations in the plane of each two.
fn of_space(n: usize) -> Vec<Affine> {
    let unit = |k: usize| (0..n).map(|i| if i == k { 1.0 } else { 0.0 }).collect::<Vec<_>>();
    let of = |name, linear, constant| Affine { name, linear, constant, is_optional: true };
    let translation = |k: usize| of(format!("translation({k})"), vec![0.0; n * n], unit(k));
    let rotation = |(from, to): (usize, usize)| {
        let mut linear = vec![0.0; n * n];
        (linear[to * n + from], linear[from * n + to]) = (1.0, -1.0);
        of(format!("rotation({from}, {to})"), linear, vec![0.0; n])
    };
    let planes = (0..n).flat_map(|from| (from + 1..n).map(move |to| (from, to)));
    (0..n).map(translation).chain(planes.map(rotation)).collect()
}

/// Generators as they are given: a name and (A, b) of each.
fn affine(given: &Bound<'_, PyDict>, n: usize) -> PyResult<Vec<Affine>> {
    let generator = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let name: String = name.extract()?;
        let (linear, constant): (Bound<'_, PyAny>, Bound<'_, PyAny>) = value.extract()?;
        let linear = array(&name, &linear)?;
        if linear.shape() != [n, n] {
            return Err(arguments::of_shape(&name, &format!("({n}, {n})"), linear.shape()));
        }
        let (linear, constant) = (arguments::numbers(&linear), vector(&name, &constant, n)?);
        Ok(Affine { name, linear, constant, is_optional: false })
    };
    given.iter().map(generator).collect()
}

/// Fails where there are no constraints.
fn require_constraints(kind: &dyn Kind) -> PyResult<()> {
    match kind.constraints() {
        0 => Err(PyTypeError::new_err(format!(
            "{} has no constraints: every (q, v) is a state of it, and there are no reactions",
            kind.name()
        ))),
        _ => Ok(()),
    }
}

/// The steps that are asked for.
fn stepping(
    h: Option<f64>,
    steps: Option<u64>,
    tolerance: Option<f64>,
    until: Option<f64>,
    rule: Option<&str>,
) -> PyResult<Stepping<'_>> {
    match (h, steps, tolerance, until) {
        (Some(h), Some(steps), None, None) => Ok(Stepping::Fixed { h, steps, rule }),
        (None, None, Some(tolerance), Some(until)) if rule.is_none() => {
            Ok(Stepping::ToError(ErrorAsked { tolerance, until }))
        }
        (None, None, Some(_), Some(_)) => {
            Err(PyTypeError::new_err("to a tolerance the method is chosen: leave rule out"))
        }
        _ => Err(PyTypeError::new_err("the steps of a run are h and steps, or tolerance and until")),
    }
}

/// Does `work` without the interpreter's lock, unless Ctrl-C ends it.
fn unless_called_off<T: Send>(py: Python<'_>, work: impl FnOnce(&Watch<'_>) -> T + Send) -> PyResult<T> {
    let (result, called_off) = watched(py, &|_, _| Ok(()), work);
    called_off.map_or(Ok(result), Err)
}

#[pymethods]
impl System {
    #[new]
    #[classmethod]
    #[pyo3(signature = (*values, **named))]
    fn new(
        class: &Bound<'_, PyType>,
        values: &Bound<'_, PyTuple>,
        named: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let kind = class.getattr_opt(KIND)?.ok_or_else(|| {
            PyTypeError::new_err("System is what the systems of this module have in common")
        })?;
        let kind = kind.cast::<KindObject>()?.get().0;
        let system = Self { model: RwLock::new(kind.zero()) };
        let fields = kind.fields();
        let all = || fields.iter().map(|field| field.name).collect::<Vec<_>>().join(", ");
        if values.len() > fields.len() {
            let (name, all) = (kind.name(), all());
            return Err(PyTypeError::new_err(format!(
                "{name}: {} values for the fields {all}",
                values.len()
            )));
        }
        let mut is_given = vec![false; fields.len()];
        for (field, value) in values.iter().enumerate() {
            system.change_field(field, &value)?;
            is_given[field] = true;
        }
        for (name, value) in named.into_iter().flatten() {
            let name: String = name.extract()?;
            let Some(field) = fields.iter().position(|field| field.name == name) else {
                return Err(PyTypeError::new_err(format!(
                    "{} has no field {name}; it has {}",
                    kind.name(),
                    all()
                )));
            };
            if is_given[field] {
                return Err(PyTypeError::new_err(format!("{}: {name} is given twice", kind.name())));
            }
            system.change_field(field, &value)?;
            is_given[field] = true;
        }
        let missing: Vec<&str> =
            fields.iter().zip(is_given).filter(|(_, given)| !given).map(|(field, _)| field.name).collect();
        if missing.is_empty() {
            Ok(system)
        } else {
            Err(PyTypeError::new_err(format!("{}: {} has to be given", kind.name(), missing.join(", "))))
        }
    }

    /// The motion from (q, v), or from (q, p).
    ///
    /// By steps of one size, h and steps, or to an error: with a tolerance, in units of q, method and step
    /// size are chosen for the motion until the time `until` from the start. Python is free to do other
    /// things meanwhile; Ctrl-C ends the run.
    ///
    /// Parameters ---------- q : configuration, n numbers v : velocity, n numbers, or p : momentum, n numbers
    /// h, steps : size and number of steps tolerance, until : a tolerance, and until when every : steps from
    /// one record to the next; start and end are recorded as well rule : one of RULES; the first unless said
    /// u : the input, or an array with one for each step t : the time at the start, of a system that takes
    /// it; 0 unless said derivatives : whether records have derivatives by start and parameters reactions :
    /// whether records have λ, of a system with constraints events : up to eight functions whose zeros are
    /// found, to rounding: each a Plane, or a callable of (t, q, v) that returns a
    ///     number; with an attribute `direction`, 1 or -1, crossings one way alone count, and one with `terminal` ends the run
    /// progress : is called with the steps taken and to take, some twenty times a second
    ///
    /// Raises
    /// ------
    /// StepError, ToleranceError, TypeError, ValueError
    #[pyo3(signature = (*, q, v=None, p=None, h=None, steps=None, tolerance=None, until=None, every=1, rule=None, u=None, t=None, derivatives=false, reactions=false, events=None, progress=None))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn run(
        &self,
        py: Python<'_>,
        q: &Bound<'_, PyAny>,
        v: Option<&Bound<'_, PyAny>>,
        p: Option<&Bound<'_, PyAny>>,
        h: Option<f64>,
        steps: Option<u64>,
        tolerance: Option<f64>,
        until: Option<f64>,
        every: u64,
        rule: Option<&str>,
        u: Option<&Bound<'_, PyAny>>,
        t: Option<f64>,
        derivatives: bool,
        reactions: bool,
        events: Option<Vec<Bound<'_, PyAny>>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Run> {
        let model = self.model();
        let kind = model.kind();
        if reactions {
            require_constraints(kind)?;
        }
        let stepping = stepping(h, steps, tolerance, until, rule)?;
        if matches!(stepping, Stepping::ToError(_)) && derivatives {
            return Err(PyTypeError::new_err(
                "to a tolerance no derivatives are carried along: leave derivatives out",
            ));
        }
        let given = StartArguments { q, v, p, u, t, steps: steps.unwrap_or(0) }.read(kind)?;
        if steps.is_none() && given.inputs.len() > kind.inputs() {
            return Err(PyValueError::new_err("u: a run to a tolerance holds one input"));
        }
        let raised = Raised::default();
        let events = watching::functions(py, events, kind.coordinates(), &raised)?;
        let asked = Asked {
            start: given.start(),
            stepping,
            every,
            along: Along { derivatives, reactions },
            events: &events,
        };
        let told = |py: Python<'_>, far: (u64, u64)| {
            progress.as_ref().map_or(Ok(()), |progress| progress.call1(py, far).map(drop))
        };
        let (ran, called_off) = watched(py, &told, |watch| model.run(&asked, watch));
        if let Some(error) = called_off {
            return Err(error);
        }
        let mut ran = ran.map_err(|refusal| of_refusal(py, refusal, rule, &kind.rules()))?;
        let n = kind.coordinates();
        match ran.stop.take() {
            None | Some(Stop::Interrupted) => {}
            Some(Stop::Events(error)) => {
                return Err(raised.take().unwrap_or_else(|| of_events(py, &error)));
            }
            Some(Stop::TooLarge(reason)) => return Err(of_memory(&reason)),
            Some(Stop::Failed(failure)) => {
                return Err(of_step(py, &failure, Some(partial(py, &mut ran.record, n)?)));
            }
        }
        let first = kind.rules();
        let rule = rule.or_else(|| first.first().copied()).unwrap_or_default();
        let run = Run::new(py, ran, n, kind.parameters().len(), h.unwrap_or(f64::NAN), rule)?;
        if let Some(breach) = run.breach_text() {
            warn(py, &breach)?;
        }
        Ok(run)
    }

    /// Many members, each a system and a start of its own, on all cores: each is bit by bit its own `run`.
    ///
    /// q, v, p and u are one row for all, or one for each member; `fields` has fields that differ, one row
    /// for each. Members that fail do not stop the others: their rows are NaN, and `failures` says why. To a
    /// tolerance a member is run again by another choice where its error passes the tolerance, watched or
    /// not: it fails where none keeps it.
    ///
    /// With a folder the results go there as Parquet files, one for each part of the members. A part is there
    /// whole or not at all, and one that is there is not computed again: killed and started again, the same
    /// call does what is missing.
    ///
    /// Parameters
    /// ----------
    /// q, v, p, u, t, h, steps, tolerance, until, rule : as of `run`
    /// every : steps from one record to the next; unless said, the end alone is recorded
    /// fields : a dict of fields that differ from member to member
    /// events : as of `run`; `events` of the result has those of all members, `t` the end of each. Members
    ///     are then run one by one. In parts events are rows among the records, with the function's place in
    ///     the list in the column `event`
    /// folder : where parts go
    /// members_per_part : members of a part
    /// first : the number of the first member, which begins a part
    /// threads : how many at most; one a core unless said, and no more
    /// progress : is called with the members that are done and all, some twenty times a second
    ///
    /// Returns
    /// -------
    /// Ends, or Parts where there is a folder
    #[pyo3(signature = (*, q, v=None, p=None, h=None, steps=None, tolerance=None, until=None, every=None, rule=None, u=None, t=None, fields=None, events=None, folder=None, members_per_part=65_536, first=0, threads=None, progress=None))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn ensemble<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: Option<&Bound<'py, PyAny>>,
        p: Option<&Bound<'py, PyAny>>,
        h: Option<f64>,
        steps: Option<u64>,
        tolerance: Option<f64>,
        until: Option<f64>,
        every: Option<u64>,
        rule: Option<&str>,
        u: Option<&Bound<'py, PyAny>>,
        t: Option<f64>,
        fields: Option<&Bound<'py, PyDict>>,
        events: Option<Vec<Bound<'_, PyAny>>>,
        folder: Option<PathBuf>,
        members_per_part: u64,
        first: u64,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let stepping = stepping(h, steps, tolerance, until, rule)?;
        if matches!(stepping, Stepping::ToError(_)) && every.is_some() {
            return Err(PyTypeError::new_err(
                "of members to a tolerance the end alone is recorded: leave every out",
            ));
        }
        let model = self.model();
        let raised = Raised::default();
        let events = watching::functions(py, events, model.kind().coordinates(), &raised)?;
        let parts = folder.map(|folder| (folder, members_per_part));
        let given = ensemble::Given {
            q,
            v,
            p,
            u,
            t,
            fields,
            first,
            stepping,
            every,
            events: &events,
            raised: &raised,
            parts,
            threads,
            progress,
        };
        ensemble::run(py, &*model, given)
    }

    /// A step from (q, v), or from (q, p), with its derivatives: A, by rules also B and by the parameters
    /// that the attribute lists.
    ///
    /// Parameters
    /// ----------
    /// q, v, p, u, t, rule : as of `run`
    /// h : the step size
    #[pyo3(signature = (*, h, q, v=None, p=None, u=None, t=None, rule=None))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn linearization(
        &self,
        py: Python<'_>,
        h: f64,
        q: &Bound<'_, PyAny>,
        v: Option<&Bound<'_, PyAny>>,
        p: Option<&Bound<'_, PyAny>>,
        u: Option<&Bound<'_, PyAny>>,
        t: Option<f64>,
        rule: Option<&str>,
    ) -> PyResult<Linearization> {
        let model = self.model();
        let kind = model.kind();
        let given = StartArguments { q, v, p, u, t, steps: 1 }.read(kind)?;
        let linearized = model
            .linearized(&given.start(), h, rule)
            .map_err(|refusal| of_refusal(py, refusal, rule, &kind.rules()))?;
        Linearization::new(py, linearized, kind.coordinates(), [kind.inputs(), kind.parameters().len()])
    }

    /// The configuration and velocity on all constraints that are nearest to (q, v) in the metric of the
    /// mass, or those of as many as there are rows: where a `run` may start.
    ///
    /// Parameters
    /// ----------
    /// q, v : arrays whose last dimension is n
    /// t : the time, of a system that takes it: one for all, or one for each state
    ///
    /// Returns
    /// -------
    /// q, v : arrays of these shapes
    #[pyo3(signature = (*, q, v, t=None))]
    fn nearest<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: &Bound<'py, PyAny>,
        t: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Pair<'py>> {
        let model = self.model();
        require_constraints(model.kind())?;
        let States { times, q, other, shape } = states(model.kind(), q, ("v", v), t)?;
        let found = unless_called_off(py, |watch| model.nearest(&times, [&q, &other], watch))?;
        let [q, v] = found.map_err(|refusal| of_refusal(py, refusal, None, &[]))?;
        let shape = [shape, vec![model.kind().coordinates()]].concat();
        Ok((to_array(py, q, shape.clone())?, to_array(py, v, shape)?))
    }

    /// The energy v·∂L/∂v − L of a state, or of as many as there are rows.
    ///
    /// Parameters
    /// ----------
    /// q, v, p : arrays whose last dimension is n
    /// t : the time, of a system that takes it: one for all, or one for each state
    #[pyo3(signature = (*, q, v=None, p=None, t=None))]
    fn energy<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: Option<&Bound<'py, PyAny>>,
        p: Option<&Bound<'py, PyAny>>,
        t: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let model = self.model();
        let (name, other, is_velocity) = match (v, p) {
            (Some(v), None) => ("v", v, true),
            (None, Some(p)) => ("p", p, false),
            _ => return Err(PyTypeError::new_err("a state is q with either v or p")),
        };
        let States { times, q, other, shape } = states(model.kind(), q, (name, other), t)?;
        let motion = if is_velocity { MotionGiven::Velocity(&other) } else { MotionGiven::Momentum(&other) };
        let energies = unless_called_off(py, |watch| model.energies(&times, &q, motion, watch))?;
        let energies = energies.map_err(|refusal| of_refusal(py, refusal, None, &[]))?;
        match (shape.is_empty(), energies.first()) {
            (true, Some(&energy)) => Ok(energy.into_pyobject(py)?.into_any()),
            _ => Ok(to_array(py, energies, shape)?.into_any()),
        }
    }

    /// What translations and rotations do to the discrete Lagrangian, to the force and to their momenta: a
    /// report for each.
    ///
    /// They are judged on segments (q0, q1) that are spread evenly: q0 in the box from low to high, each
    /// coordinate of q1 − q0 within ∓reach, about h times the speed. Both ends are moved onto the
    /// constraints, if there are any, and translations and rotations that leave these are left out.
    ///
    /// Parameters
    /// ----------
    /// h, u, t, rule : as of `run`; the rule midpoint, trapezoidal, fitted or one-sided
    /// low, high, reach : n numbers each
    /// samples : how many segments
    /// generators : a dict of others, ξ(q) = A q + b: name to (A, b)
    #[pyo3(signature = (*, h, low, high, reach, samples=100, generators=None, u=None, t=None, rule=None))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn symmetries(
        &self,
        py: Python<'_>,
        h: f64,
        low: &Bound<'_, PyAny>,
        high: &Bound<'_, PyAny>,
        reach: &Bound<'_, PyAny>,
        samples: usize,
        generators: Option<&Bound<'_, PyDict>>,
        u: Option<&Bound<'_, PyAny>>,
        t: Option<f64>,
        rule: Option<&str>,
    ) -> PyResult<Vec<Symmetry>> {
        let model = self.model();
        let kind = model.kind();
        let n = kind.coordinates();
        let generators = generators.map_or_else(|| Ok(of_space(n)), |given| affine(given, n))?;
        let (low, high) = (vector("low", low, n)?, vector("high", high, n)?);
        let reach = vector("reach", reach, n)?;
        let (inputs, time) = inputs(kind, u, t, 1)?;
        let region = Region { low: &low, high: &high, reach: &reach, samples };
        let given = motion::Given { inputs: &inputs, time };
        let found =
            unless_called_off(py, |watch| model.symmetries(given, h, rule, &generators, &region, watch))?;
        let found = found.map_err(|refusal| of_refusal(py, refusal, rule, &kind.rules()))?;
        Ok(found.into_iter().map(Symmetry::from).collect())
    }

    /// Where the energy of a run went, by the rule's own account of what forces did.
    ///
    /// Parameters
    /// ----------
    /// h, steps, q, v, p, u, t, rule : as of `run`; the rule midpoint, trapezoidal, fitted or one-sided
    #[pyo3(signature = (*, h, steps, q, v=None, p=None, u=None, t=None, rule=None))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn energy_ledger(
        &self,
        py: Python<'_>,
        h: f64,
        steps: u64,
        q: &Bound<'_, PyAny>,
        v: Option<&Bound<'_, PyAny>>,
        p: Option<&Bound<'_, PyAny>>,
        u: Option<&Bound<'_, PyAny>>,
        t: Option<f64>,
        rule: Option<&str>,
    ) -> PyResult<EnergyLedger> {
        let model = self.model();
        let kind = model.kind();
        let given = StartArguments { q, v, p, u, t, steps: 1 }.read(kind)?;
        let ledger = unless_called_off(py, |watch| model.ledger(&given.start(), h, rule, steps, watch))?;
        let ledger = ledger.map_err(|refusal| of_refusal(py, refusal, rule, &kind.rules()))?;
        Ok(ledger.into())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let model = self.model();
        let kind = model.kind();
        let shown = kind.fields().iter().zip(self.values(py)?).map(|(field, value)| {
            let value = if field.dimensions.is_empty() { value } else { value.call_method0("tolist")? };
            Ok(format!("{}={}", field.name, value.repr()?))
        });
        Ok(format!("{}({})", kind.name(), shown.collect::<PyResult<Vec<_>>>()?.join(", ")))
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let Ok(other) = other.cast::<Self>() else { return false };
        let (left, right) = (self.model(), other.get().model());
        let numbers = |model: &dyn Model| {
            let fields = 0..model.kind().fields().len();
            fields
                .map(|field| (0..).map_while(|index| model.entry(field, index)).collect::<Vec<_>>())
                .collect::<Vec<_>>()
        };
        left.kind().name() == right.kind().name() && numbers(&*left) == numbers(&*right)
    }

    fn __reduce__<'py>(this: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyType>, Bound<'py, PyTuple>)> {
        let py = this.py();
        Ok((this.get_type(), PyTuple::new(py, this.get().values(py)?)?))
    }
}
