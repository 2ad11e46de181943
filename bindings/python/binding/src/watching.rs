//! Event functions as Python gives them.

use core::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use dalembert::run::events::Crossing;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyModule;

use crate::arguments::{expected, vector};
use crate::arrays::to_array;
use crate::events::{Event as Asked, Function, MOST};
use crate::model::Kind;

/// A plane that a run crosses: q·a + v·b = value.
///
/// An event function like any other, which is asked for without Python.
///
/// Parameters
/// ----------
/// q : a, n numbers
/// v : b, n numbers; 0 unless said
/// value : the right side
/// direction : 1 counts crossings from below, -1 those from above, 0 all
/// terminal : whether the run ends there
#[pyclass(frozen, get_all)]
pub struct Plane {
    /// a.
    q: Vec<f64>,
    /// b.
    v: Option<Vec<f64>>,
    /// The right side.
    value: f64,
    /// Which crossings count.
    direction: f64,
    /// Whether the run ends there.
    terminal: bool,
}

#[pymethods]
impl Plane {
    #[new]
    #[pyo3(signature = (q, v=None, *, value=0.0, direction=0.0, terminal=false))]
    fn new(q: Vec<f64>, v: Option<Vec<f64>>, value: f64, direction: f64, terminal: bool) -> Self {
        Self { q, v, value, direction, terminal }
    }

    fn __repr__(&self) -> String {
        let Self { q, v, value, direction, terminal } = self;
        let v = v.as_ref().map_or_else(String::new, |v| format!(", v={v:?}"));
        let terminal = if *terminal { ", terminal=True" } else { "" };
        format!("Plane(q={q:?}{v}, value={value:?}, direction={direction:?}{terminal})")
    }
}

/// A sphere in the space of configurations that a run crosses: |q − center| = radius.
///
/// A `direction` of 1 counts crossings from inside.
///
/// Parameters
/// ----------
/// center : n numbers
/// radius : its radius
/// direction : 1 counts crossings outwards, -1 those inwards, 0 all
/// terminal : whether the run ends there
#[pyclass(frozen, get_all)]
pub struct Sphere {
    /// Its centre.
    center: Vec<f64>,
    /// Its radius.
    radius: f64,
    /// Which crossings count.
    direction: f64,
    /// Whether the run ends there.
    terminal: bool,
}

#[pymethods]
impl Sphere {
    #[new]
    #[pyo3(signature = (center, radius, *, direction=0.0, terminal=false))]
    fn new(center: Vec<f64>, radius: f64, direction: f64, terminal: bool) -> Self {
        Self { center, radius, direction, terminal }
    }

    fn __repr__(&self) -> String {
        let Self { center, radius, direction, terminal } = self;
        let terminal = if *terminal { ", terminal=True" } else { "" };
        format!("Sphere(center={center:?}, radius={radius:?}, direction={direction:?}{terminal})")
    }
}

/// An energy v·∂L/∂v − L that a run passes.
///
/// Parameters
/// ----------
/// value : the energy
/// direction : 1 counts passages from below, -1 those from above, 0 all
/// terminal : whether the run ends there
#[pyclass(frozen, get_all)]
pub struct Energy {
    /// The energy.
    value: f64,
    /// Which passages count.
    direction: f64,
    /// Whether the run ends there.
    terminal: bool,
}

#[pymethods]
impl Energy {
    #[new]
    #[pyo3(signature = (value, *, direction=0.0, terminal=false))]
    fn new(value: f64, direction: f64, terminal: bool) -> Self {
        Self { value, direction, terminal }
    }

    fn __repr__(&self) -> String {
        let Self { value, direction, terminal } = self;
        let terminal = if *terminal { ", terminal=True" } else { "" };
        format!("Energy({value:?}, direction={direction:?}{terminal})")
    }
}

/// An event function of `fn events` in the Rust block of the system, of as many as `EVENTS` says.
///
/// Parameters
/// ----------
/// index : which of them, from 0
/// direction : 1 counts zeros that are passed from below, -1 those from above, 0 all
/// terminal : whether the run ends there
#[pyclass(frozen, get_all)]
pub struct Event {
    /// Which of them.
    index: usize,
    /// Which zeros count.
    direction: f64,
    /// Whether the run ends there.
    terminal: bool,
}

#[pymethods]
impl Event {
    #[new]
    #[pyo3(signature = (index=0, *, direction=0.0, terminal=false))]
    fn new(index: usize, direction: f64, terminal: bool) -> Self {
        Self { index, direction, terminal }
    }

    fn __repr__(&self) -> String {
        let Self { index, direction, terminal } = self;
        let terminal = if *terminal { ", terminal=True" } else { "" };
        format!("Event({index}, direction={direction:?}{terminal})")
    }
}

/// The first exception that event functions have raised. It calls off what asks them.
#[derive(Default)]
pub struct Raised {
    first: Mutex<Option<PyErr>>,
    cancel: AtomicBool,
}

impl Raised {
    fn put(&self, error: PyErr) {
        self.first.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
        self.cancel.store(true, Ordering::Relaxed);
    }

    /// Takes the exception out.
    pub fn take(&self) -> Option<PyErr> {
        self.first.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Whether all is to end: others may set it too.
    pub fn cancel(&self) -> &AtomicBool {
        &self.cancel
    }
}

/// The functions that `events=` lists, for a system of this kind: those of this module and callables of
/// (t, q, v). What a callable raises is put into `raised`.
///
/// # Errors
/// `TypeError`, `ValueError`.
pub fn functions<'a>(
    py: Python<'_>,
    given: Option<&Bound<'_, PyAny>>,
    kind: &dyn Kind,
    raised: &'a Raised,
) -> PyResult<Vec<Asked<'a>>> {
    let given = given.map(listed).transpose()?.unwrap_or_default();
    if given.len() > MOST {
        return Err(PyValueError::new_err(format!(
            "events: expected at most {MOST} functions, got {}",
            given.len()
        )));
    }
    given.into_iter().map(|function| event(py, &function, kind, raised)).collect()
}

/// The functions that are given, or the one that is.
fn listed<'py>(given: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, PyAny>>> {
    if given.is_callable() || is_event(given) {
        return Ok(vec![given.clone()]);
    }
    given.extract().map_err(|_| PyTypeError::new_err(NOT_EVENTS))
}

fn is_event(given: &Bound<'_, PyAny>) -> bool {
    given.is_instance_of::<Plane>()
        || given.is_instance_of::<Sphere>()
        || given.is_instance_of::<Energy>()
        || given.is_instance_of::<Event>()
}

/// The message of an argument that is no event function.
const NOT_EVENTS: &str = "events: expected Plane, Sphere, Energy, Event, or functions of (t, q, v)";

fn event<'a>(
    py: Python<'_>,
    given: &Bound<'_, PyAny>,
    kind: &dyn Kind,
    raised: &'a Raised,
) -> PyResult<Asked<'a>> {
    let attribute = |name: &str| given.getattr_opt(name);
    let direction: f64 = attribute("direction")?.map_or(Ok(0.0), |direction| direction.extract())?;
    let is_terminal = attribute("terminal")?.map_or(Ok(false), |terminal| terminal.is_truthy())?;
    let crossing = match direction {
        direction if direction > 0.0 => Crossing::Rising,
        direction if direction < 0.0 => Crossing::Falling,
        _ => Crossing::Either,
    };
    let n = kind.coordinates();
    let function = if let Ok(sphere) = given.cast::<Sphere>() {
        let Sphere { center, radius, .. } = sphere.get();
        let center = vector("events: center", &center.into_pyobject(py)?.into_any(), n)?;
        Function::Sphere { center, radius: *radius }
    } else if let Ok(energy) = given.cast::<Energy>() {
        Function::Energy(energy.get().value)
    } else if let Ok(event) = given.cast::<Event>() {
        let (index, events) = (event.get().index, kind.events());
        if index >= events {
            let name = kind.name();
            return Err(PyValueError::new_err(format!(
                "events: {name} states {events} event functions, there is none with the index {index}; its block \
                 has `fn events`"
            )));
        }
        Function::OfBlock(index)
    } else if let Ok(plane) = given.cast::<Plane>() {
        let Plane { q, v, value, .. } = plane.get();
        let v = v
            .as_ref()
            .map_or(Ok(Vec::new()), |v| vector("events: v", &v.into_pyobject(py)?.into_any(), n))?;
        Function::Plane { q: vector("events: q", &q.into_pyobject(py)?.into_any(), n)?, v, value: *value }
    } else if given.is_callable() {
        let callable = given.clone().unbind();
        Function::Given(Box::new(move |t, q, v| {
            let value = Python::attach(|py| -> PyResult<f64> {
                let vector = |numbers: &[f64]| to_array(py, numbers.to_vec(), [numbers.len()]);
                let value = callable.call1(py, (t, vector(q)?, vector(v)?))?;
                value.extract(py).map_err(|_| {
                    expected("events: a function of (t, q, v)", "a number from it", value.bind(py))
                })
            });
            value.unwrap_or_else(|error| {
                raised.put(error);
                f64::NAN
            })
        }))
    } else {
        return Err(PyTypeError::new_err(NOT_EVENTS));
    };
    Ok(Asked { function, crossing, is_terminal })
}

/// Adds the classes to `module`, as its own.
///
/// # Errors
/// Those of Python.
pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<Plane>()?;
    module.add_class::<Sphere>()?;
    module.add_class::<Energy>()?;
    module.add_class::<Event>()?;
    for name in ["Plane", "Sphere", "Energy", "Event"] {
        module.getattr(name)?.setattr("__module__", module.name()?)?;
    }
    Ok(())
}
