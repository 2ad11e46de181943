//! Exceptions: the errors of steps with their data.

use dalembert::StepError;
use dalembert::run::events::EventError;
use dalembert_ensemble::MemberError;
use pyo3::exceptions::{PyArithmeticError, PyMemoryError, PyRuntimeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyModule, PyType};

use crate::arrays::to_array;
use crate::many::Failed;
use crate::record::Failure;
use crate::refusal::Refusal;

/// The classes of exceptions of the module.
struct Classes {
    step: Py<PyType>,
    tolerance: Py<PyType>,
    event: Py<PyType>,
    breach: Py<PyType>,
}

static CLASSES: PyOnceLock<Classes> = PyOnceLock::new();

const STEP_ERROR: &str = "A step that could not be taken.

kind     which error: 'NoRealSolution', 'NoDerivative', …
data     what is known of it: a dict
step     the step that failed, counted from 0; None of a member of an ensemble
t        the time of the last good state
q, p     the last good state; None as far as the start is none
partial  what a run had recorded until then: a dict of arrays t, q, v, p, energy; None elsewhere";

const TOLERANCE_ERROR: &str = "No method was chosen for the tolerance: the message says why.";

const EVENT_ERROR: &str = "An event function that cannot be followed: the message says which and when.";

const BREACH_WARNING: &str = "The error expected has passed the tolerance: `run.breach` says where.";

/// Adds the exceptions to `module`.
///
/// # Errors
/// Those of Python.
pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    let classes = CLASSES.get_or_try_init(py, || {
        let class = |name: &str, base: Bound<'_, PyType>, documentation: &str| -> PyResult<Py<PyType>> {
            let namespace = PyDict::new(py);
            namespace.set_item("__doc__", documentation)?;
            namespace.set_item("__module__", module.name()?)?;
            let class = py.get_type::<PyType>().call1((name, (base,), namespace))?;
            Ok(class.cast_into::<PyType>()?.unbind())
        };
        let arithmetic = || py.get_type::<PyArithmeticError>();
        PyResult::Ok(Classes {
            step: class("StepError", arithmetic(), STEP_ERROR)?,
            tolerance: class("ToleranceError", arithmetic(), TOLERANCE_ERROR)?,
            event: class("EventError", arithmetic(), EVENT_ERROR)?,
            breach: class("BreachWarning", py.get_type::<PyUserWarning>(), BREACH_WARNING)?,
        })
    })?;
    module.add("StepError", &classes.step)?;
    module.add("ToleranceError", &classes.tolerance)?;
    module.add("EventError", &classes.event)?;
    module.add("BreachWarning", &classes.breach)
}

fn classes(py: Python<'_>) -> PyResult<&Classes> {
    CLASSES.get(py).ok_or_else(|| PyValueError::new_err("the module was not imported"))
}

/// The exception of a step that failed.
pub fn of_step(py: Python<'_>, failure: &Failure, partial: Option<Bound<'_, PyDict>>) -> PyErr {
    let Failure { error, step, time, state } = failure;
    let message = format!("step {step}, from t = {time}: {error}");
    let exception = step_error(py, message, error, Some(*step), *time, state, partial);
    exception.map_or_else(|error| error, PyErr::from_value)
}

fn step_error<'py>(
    py: Python<'py>,
    message: String,
    error: &StepError,
    step: Option<u64>,
    time: f64,
    [q, p]: &[Vec<f64>; 2],
    partial: Option<Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let exception = classes(py)?.step.bind(py).call1((message,))?;
    let (kind, data) = described(py, error)?;
    exception.setattr("kind", kind)?;
    exception.setattr("data", data)?;
    exception.setattr("step", step)?;
    exception.setattr("t", time)?;
    for (name, vector) in [("q", q), ("p", p)] {
        let vector =
            (!vector.is_empty()).then(|| to_array(py, vector.clone(), [vector.len()])).transpose()?;
        exception.setattr(name, vector)?;
    }
    exception.setattr("partial", partial)?;
    Ok(exception)
}

/// Why a member of an ensemble is not what was asked for, as an exception that is not raised.
///
/// # Errors
/// Those of Python.
pub fn of_member<'py>(py: Python<'py>, failed: &Failed) -> PyResult<Bound<'py, PyAny>> {
    let Failed { number, error, time, state } = failed;
    let message = format!("member {number}, at t = {time}: {error}");
    match error {
        MemberError::Step(error) => step_error(py, message, error, None, *time, state, None),
        MemberError::Tolerance(_) => classes(py)?.tolerance.bind(py).call1((message,)),
        MemberError::Event(_) => classes(py)?.event.bind(py).call1((message,)),
        _ => Ok(PyRuntimeError::new_err(message).into_value(py).into_bound(py).into_any()),
    }
}

/// The name of an error and what is known of it.
fn described<'py>(py: Python<'py>, error: &StepError) -> PyResult<(&'static str, Bound<'py, PyDict>)> {
    let data = PyDict::new(py);
    let kind = match *error {
        StepError::StepSize { h } => {
            data.set_item("h", h)?;
            "StepSize"
        }
        StepError::Time { time, h } => {
            data.set_item("time", time)?;
            data.set_item("h", h)?;
            "Time"
        }
        StepError::TimeScale { scale, h } => {
            data.set_item("scale", scale)?;
            data.set_item("h", h)?;
            "TimeScale"
        }
        StepError::NonFinite { quantity, index } => {
            data.set_item("quantity", quantity.to_string())?;
            data.set_item("index", index)?;
            "NonFinite"
        }
        StepError::Overflow { quantity, index } => {
            data.set_item("quantity", quantity.to_string())?;
            data.set_item("index", index)?;
            "Overflow"
        }
        StepError::NoDerivative { function, coordinate, place } => {
            data.set_item("function", function.to_string())?;
            data.set_item("coordinate", coordinate)?;
            data.set_item("operation", place.map(|place| format!("{:?}", place.written.operation)))?;
            data.set_item("written", place.map(|place| place.written.text))?;
            data.set_item("argument", place.map(|place| place.argument))?;
            "NoDerivative"
        }
        StepError::DegenerateLagrangian { column } => {
            data.set_item("column", column)?;
            "DegenerateLagrangian"
        }
        StepError::SingularCoordinates { column } => {
            data.set_item("column", column)?;
            "SingularCoordinates"
        }
        StepError::MassNotPositiveDefinite { column } => {
            data.set_item("column", column)?;
            "MassNotPositiveDefinite"
        }
        StepError::NoVelocity { residual } => {
            data.set_item("residual", residual)?;
            "NoVelocity"
        }
        StepError::SingularNewtonMatrix { iteration, column } => {
            data.set_item("iteration", iteration)?;
            data.set_item("column", column)?;
            "SingularNewtonMatrix"
        }
        StepError::NoRealSolution { iteration, residual } => {
            data.set_item("iteration", iteration)?;
            data.set_item("residual", residual)?;
            "NoRealSolution"
        }
        StepError::LostPrecision { residual, floor } => {
            data.set_item("residual", residual)?;
            data.set_item("floor", floor)?;
            "LostPrecision"
        }
        StepError::NotConverged { iterations, residual, floor } => {
            data.set_item("iterations", iterations)?;
            data.set_item("residual", residual)?;
            data.set_item("floor", floor)?;
            "NotConverged"
        }
        StepError::GeneratedDiffers { function, compared, generated, written } => {
            data.set_item("function", function.to_string())?;
            data.set_item("compared", format!("{compared:?}").to_lowercase())?;
            data.set_item("generated", generated)?;
            data.set_item("written", written)?;
            "GeneratedDiffers"
        }
        StepError::OffConstraint { constraint, value } => {
            data.set_item("constraint", constraint)?;
            data.set_item("value", value)?;
            "OffConstraint"
        }
        StepError::LeavesConstraint { constraint, rate } => {
            data.set_item("constraint", constraint)?;
            data.set_item("rate", rate)?;
            "LeavesConstraint"
        }
        StepError::DependentConstraints { constraint } => {
            data.set_item("constraint", constraint)?;
            "DependentConstraints"
        }
        StepError::NegativeFriction { component, limit } => {
            data.set_item("component", component)?;
            data.set_item("limit", limit)?;
            "NegativeFriction"
        }
        StepError::NotConvex { component, h, enough } => {
            data.set_item("component", component)?;
            data.set_item("h", h)?;
            data.set_item("enough", enough)?;
            "NotConvex"
        }
        StepError::AtLimitOfFriction { component } => {
            data.set_item("component", component)?;
            "AtLimitOfFriction"
        }
        _ => "StepError",
    };
    Ok((kind, data))
}

/// The exception of a run that did not begin.
pub fn of_refusal(py: Python<'_>, refusal: Refusal, rule: Option<&str>, rules: &[&str]) -> PyErr {
    match refusal {
        Refusal::Rule => {
            let rules = rules.join(", ");
            let rule = rule.unwrap_or("none");
            PyValueError::new_err(format!(
                "rule: expected one of {rules}, got {rule}; the attribute of the system lists them"
            ))
        }
        Refusal::NotDriven => PyValueError::new_err(
            "rule: inputs that change, reactions and derivatives are those of rules; got a splitting or none",
        ),
        Refusal::NotWatched => PyValueError::new_err(
            "events and times: those of runs that hold one input, without derivatives and reactions; leave these \
             out, or ask in another call",
        ),
        Refusal::NotChecked => PyValueError::new_err(
            "rule: symmetries and energies are accounted for by midpoint, trapezoidal, fitted and one_sided rules",
        ),
        Refusal::NotHolonomic => PyValueError::new_err(
            "symmetries: those of systems without constraints of velocity, which leave a step without a discrete \
             Lagrangian; ask `energy_ledger`, or look at a momentum along a run",
        ),
        Refusal::Samples(error) => PyValueError::new_err(error.to_string()),
        Refusal::NoError => PyValueError::new_err(
            "tolerance: the rules of this system offer no method for a tolerance; give h and steps",
        ),
        Refusal::Tolerance(error) => match classes(py) {
            Ok(classes) => {
                // The limit has another name here.
                let text = error.to_string().replace("`at_most`", "`max_steps`");
                PyErr::from_type(classes.tolerance.bind(py).clone(), text)
            }
            Err(error) => error,
        },
        Refusal::Start(failure) => of_step(py, &failure, None),
        Refusal::CalledOff => PyRuntimeError::new_err("the call was called off"),
    }
}

/// The exception of events that cannot be followed.
pub fn of_events(py: Python<'_>, error: &EventError) -> PyErr {
    classes(py).map_or_else(
        |error| error,
        |classes| PyErr::from_type(classes.event.bind(py).clone(), error.to_string()),
    )
}

/// The exception of more records than memory holds.
pub fn of_memory(reason: &std::collections::TryReserveError) -> PyErr {
    PyMemoryError::new_err(format!("records of the run: {reason}; take a larger `every`"))
}

/// Warns of an error that has passed the tolerance.
///
/// # Errors
/// The warning, where it was made an error.
pub fn warn(py: Python<'_>, message: &str) -> PyResult<()> {
    let message = std::ffi::CString::new(message)?;
    PyErr::warn(py, classes(py)?.breach.bind(py), &message, 1)
}
