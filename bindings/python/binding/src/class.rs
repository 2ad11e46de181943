//! The class of a system in Python, and what its methods do.

use std::path::PathBuf;
use std::sync::{PoisonError, RwLock};

use pyo3::exceptions::{PyAttributeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple, PyType};

use crate::arguments::{
    count, count_from, number, real, require_callable, require_finite, text, time, vector,
};
use crate::arrays::to_array;
use crate::checks::Region;
use crate::ensemble;
use crate::error::{of_events, of_memory, of_refusal, of_step, warn};
use crate::given_fields::entries;
use crate::linearization::Linearization;
use crate::model::{Kind, Model, MotionGiven, Run as Asked};
use crate::motion::{self, Along};
use crate::offer::Stepping;
use crate::record::{Recorded, Stop};
use crate::reports::{EnergyLedger, Symmetry};
use crate::results::{Run, partial};
use crate::starts::{
    Pair, StartArguments, States, affine, either, inputs, of_space, require_constraints, states,
};
use crate::stepping::{self, timed, whole};
use crate::table;
use crate::watch::{Watch, watched};
use crate::watching::{self, Raised};

/// Members of a part unless said.
const MEMBERS_PER_PART: u64 = 65_536;

/// Segments on which symmetries are judged unless said.
const SAMPLES: usize = 100;

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
        if about.is_table {
            return table::value(py, about.name, &numbers.collect::<Vec<_>>());
        }
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
        model.change_field(field, &entries).map_err(|wrong| PyValueError::new_err(wrong.to_string()))
    }

    /// The values of all fields.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let fields = self.model().kind().fields().len();
        (0..fields).map(|field| self.field(py, field)).collect()
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
    /// By steps of one size, `h` with `steps` or `until`, or to a tolerance, `tolerance` with `until`: method
    /// and step size are then chosen for the motion. The call releases the GIL; Ctrl-C ends it.
    ///
    /// Parameters
    /// ----------
    /// q : configuration, n numbers
    /// v, p : velocity or momentum, n numbers
    /// h : step size; below 0 the run goes backwards
    /// steps : number of steps
    /// tolerance : bound of the error of q, in units of q
    /// until : time at the end; where it is no multiple of h the last step is as long as it takes to there
    /// times : times of the records (dense output), in the order of the run; the last one is the end unless
    ///     steps or until says so. Each state is of the method's own order, to the tolerance
    /// every : steps from one record to the next, if there are no times; start and end are recorded as well
    /// max_steps : limit of the steps; an error before the run where it takes more
    /// rule : one of RULES; the first unless said
    /// u : input, or an array with one for each step
    /// t : time at the start, of a system that takes the time; 0 unless said
    /// derivatives : whether records have derivatives by start and parameters
    /// reactions : whether records have λ, of a system with constraints
    /// events : up to eight functions whose zeros are found, to rounding: each a Plane, a Sphere, an Energy,
    ///     an Event of the Rust block, or a callable of (t, q, v) that returns a number; with an attribute
    ///     `direction`, 1 or -1, crossings one way alone count, and one with `terminal` ends the run
    /// progress : callable, called with the steps taken and to take, some twenty times a second
    ///
    /// Returns
    /// -------
    /// Run
    ///
    /// Raises
    /// ------
    /// StepError, ToleranceError, EventError, TypeError, ValueError, MemoryError
    #[pyo3(signature = (*, q, v=None, p=None, h=None, steps=None, tolerance=None, until=None, times=None, every=None, max_steps=None, rule=None, u=None, t=None, derivatives=false, reactions=false, events=None, progress=None))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn run(
        &self,
        py: Python<'_>,
        q: &Bound<'_, PyAny>,
        v: Option<&Bound<'_, PyAny>>,
        p: Option<&Bound<'_, PyAny>>,
        h: Option<&Bound<'_, PyAny>>,
        steps: Option<&Bound<'_, PyAny>>,
        tolerance: Option<&Bound<'_, PyAny>>,
        until: Option<&Bound<'_, PyAny>>,
        times: Option<&Bound<'_, PyAny>>,
        every: Option<&Bound<'_, PyAny>>,
        max_steps: Option<&Bound<'_, PyAny>>,
        rule: Option<&Bound<'_, PyAny>>,
        u: Option<&Bound<'_, PyAny>>,
        t: Option<&Bound<'_, PyAny>>,
        derivatives: bool,
        reactions: bool,
        events: Option<&Bound<'_, PyAny>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Run> {
        require_callable(py, "progress", progress.as_ref())?;
        let model = self.model();
        let kind = model.kind();
        if reactions {
            require_constraints(kind)?;
        }
        let (rule, t) = (text("rule", rule)?, real("t", t)?);
        let rule = rule.as_deref();
        let origin = time(kind, t)?;
        let times = times.map(stepping::times).transpose()?;
        let every = count_from(1, "every", every)?;
        if times.is_some() && every.is_some() {
            return Err(PyTypeError::new_err("times and every: give one of them, not both"));
        }
        let stepping = stepping::Given { h, steps, tolerance, until, max_steps, rule };
        let mut stepping = stepping.read(origin, times.as_deref())?;
        if matches!(stepping, Stepping::ToError(_)) && derivatives {
            return Err(PyTypeError::new_err(
                "derivatives: a run to a tolerance carries none along; give h in place of tolerance",
            ));
        }
        let steps = if let Stepping::Fixed { steps, .. } = stepping { steps } else { 0 };
        let given = StartArguments { q, v, p, u, t, steps }.read(kind)?;
        let changes_input = given.inputs.len() > kind.inputs();
        if matches!(stepping, Stepping::ToError(_)) && changes_input {
            return Err(PyValueError::new_err("u: a run to a tolerance holds one input"));
        }
        let along = Along { derivatives, reactions };
        if changes_input || along.is_any() {
            let why = "a run with an input for each step, derivatives or reactions takes";
            stepping = whole(stepping, why)?;
        }
        let timed = times.map(|times| timed(&times, origin, &stepping)).transpose()?;
        let recorded = timed.as_deref().map_or(Recorded::Every(every.unwrap_or(1)), Recorded::At);
        let raised = Raised::default();
        let events = watching::functions(py, events, kind, &raised)?;
        let asked = Asked { start: given.start(), stepping, recorded, along, events: &events };
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
        let h = if let Stepping::Fixed { h, .. } = stepping { h } else { f64::NAN };
        let run = Run::new(py, ran, origin, n, kind.parameters().len(), h, rule)?;
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
    /// q, v, p, u, t, h, steps, tolerance, until, rule : as of `run`; members take whole steps
    /// every : steps from one record to the next; unless said, the end alone is recorded
    /// fields : a dict of fields that differ from member to member; in parts they are columns
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
    #[pyo3(signature = (*, q, v=None, p=None, h=None, steps=None, tolerance=None, until=None, every=None, rule=None, u=None, t=None, fields=None, events=None, folder=None, members_per_part=None, first=None, threads=None, progress=None))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn ensemble<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        v: Option<&Bound<'py, PyAny>>,
        p: Option<&Bound<'py, PyAny>>,
        h: Option<&Bound<'py, PyAny>>,
        steps: Option<&Bound<'py, PyAny>>,
        tolerance: Option<&Bound<'py, PyAny>>,
        until: Option<&Bound<'py, PyAny>>,
        every: Option<&Bound<'py, PyAny>>,
        rule: Option<&Bound<'py, PyAny>>,
        u: Option<&Bound<'py, PyAny>>,
        t: Option<&Bound<'py, PyAny>>,
        fields: Option<&Bound<'py, PyAny>>,
        events: Option<&Bound<'py, PyAny>>,
        folder: Option<PathBuf>,
        members_per_part: Option<&Bound<'py, PyAny>>,
        first: Option<&Bound<'py, PyAny>>,
        threads: Option<&Bound<'py, PyAny>>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        require_callable(py, "progress", progress.as_ref())?;
        let model = self.model();
        let (rule, t) = (text("rule", rule)?, real("t", t)?);
        let origin = time(model.kind(), t)?;
        let stepping = stepping::Given { h, steps, tolerance, until, max_steps: None, rule: rule.as_deref() };
        let stepping = whole(stepping.read(origin, None)?, "members take")?;
        let every = count_from(1, "every", every)?;
        if matches!(stepping, Stepping::ToError(_)) && every.is_some() {
            return Err(PyTypeError::new_err(
                "every: of members to a tolerance the end alone is recorded; leave every out",
            ));
        }
        let members_per_part = count_from(1, "members_per_part", members_per_part)?;
        let members_per_part = members_per_part.unwrap_or(MEMBERS_PER_PART);
        let first = count("first", first)?.unwrap_or(0);
        let threads = count_from(1, "threads", threads)?.map(|threads| threads as usize);
        let raised = Raised::default();
        let events = watching::functions(py, events, model.kind(), &raised)?;
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
        h: &Bound<'_, PyAny>,
        q: &Bound<'_, PyAny>,
        v: Option<&Bound<'_, PyAny>>,
        p: Option<&Bound<'_, PyAny>>,
        u: Option<&Bound<'_, PyAny>>,
        t: Option<&Bound<'_, PyAny>>,
        rule: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Linearization> {
        let model = self.model();
        let kind = model.kind();
        let (h, t, rule) = (stepping::size(h)?, real("t", t)?, text("rule", rule)?);
        let rule = rule.as_deref();
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
        require_finite("q", &q)?;
        require_finite("v", &other)?;
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
        let (name, other, is_velocity) = either(v, p)?;
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
    #[pyo3(signature = (*, h, low, high, reach, samples=None, generators=None, u=None, t=None, rule=None))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn symmetries(
        &self,
        py: Python<'_>,
        h: &Bound<'_, PyAny>,
        low: &Bound<'_, PyAny>,
        high: &Bound<'_, PyAny>,
        reach: &Bound<'_, PyAny>,
        samples: Option<&Bound<'_, PyAny>>,
        generators: Option<&Bound<'_, PyDict>>,
        u: Option<&Bound<'_, PyAny>>,
        t: Option<&Bound<'_, PyAny>>,
        rule: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Vec<Symmetry>> {
        let model = self.model();
        let kind = model.kind();
        let (h, t, rule) = (stepping::size(h)?, real("t", t)?, text("rule", rule)?);
        let rule = rule.as_deref();
        let samples = count("samples", samples)?.map_or(SAMPLES, |samples| samples as usize);
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
        h: &Bound<'_, PyAny>,
        steps: &Bound<'_, PyAny>,
        q: &Bound<'_, PyAny>,
        v: Option<&Bound<'_, PyAny>>,
        p: Option<&Bound<'_, PyAny>>,
        u: Option<&Bound<'_, PyAny>>,
        t: Option<&Bound<'_, PyAny>>,
        rule: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<EnergyLedger> {
        let model = self.model();
        let kind = model.kind();
        let (h, t, rule) = (stepping::size(h)?, real("t", t)?, text("rule", rule)?);
        let rule = rule.as_deref();
        let steps = count("steps", Some(steps))?.unwrap_or(0);
        let given = StartArguments { q, v, p, u, t, steps: 1 }.read(kind)?;
        let ledger = unless_called_off(py, |watch| model.ledger(&given.start(), h, rule, steps, watch))?;
        let ledger = ledger.map_err(|refusal| of_refusal(py, refusal, rule, &kind.rules()))?;
        Ok(ledger.into())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let model = self.model();
        let kind = model.kind();
        let shown = kind.fields().iter().zip(self.values(py)?).map(|(field, value)| {
            let is_array = !field.dimensions.is_empty() && !field.is_table;
            let value = if is_array { value.call_method0("tolist")? } else { value };
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
