//! States, inputs and generators, as Python gives them.

use numpy::{PyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arguments::{self, array, expected, input, rows, time, vector};
use crate::checks::Affine;
use crate::model::{Kind, MotionGiven, Start};

/// The configuration and velocity or momentum of a start, and the inputs.
pub struct Given {
    q: Vec<f64>,
    other: Vec<f64>,
    is_velocity: bool,
    /// The inputs, one after the other.
    pub inputs: Vec<f64>,
    /// The time.
    pub time: f64,
}

impl Given {
    /// The start.
    pub fn start(&self) -> Start<'_> {
        let motion = if self.is_velocity {
            MotionGiven::Velocity(&self.other)
        } else {
            MotionGiven::Momentum(&self.other)
        };
        Start { q: &self.q, motion, inputs: &self.inputs, time: self.time }
    }
}

/// The arguments of a method of a system that say where it starts.
pub struct StartArguments<'a, 'py> {
    /// Its configuration.
    pub q: &'a Bound<'py, PyAny>,
    /// Its velocity.
    pub v: Option<&'a Bound<'py, PyAny>>,
    /// Its momentum.
    pub p: Option<&'a Bound<'py, PyAny>>,
    /// The inputs.
    pub u: Option<&'a Bound<'py, PyAny>>,
    /// The time.
    pub t: Option<f64>,
    /// For how many steps there may be inputs.
    pub steps: u64,
}

impl StartArguments<'_, '_> {
    /// Reads them, for a system of this kind.
    ///
    /// # Errors
    /// `TypeError`, `ValueError`.
    pub fn read(&self, kind: &dyn Kind) -> PyResult<Given> {
        let n = kind.coordinates();
        let (name, given, is_velocity) = either(self.v, self.p)?;
        let (inputs, time) = inputs(kind, self.u, self.t, self.steps)?;
        Ok(Given { q: vector("q", self.q, n)?, other: vector(name, given, n)?, is_velocity, inputs, time })
    }
}

/// The velocity or the momentum, with its name and whether it is a velocity.
///
/// # Errors
/// `TypeError` unless one of them is given.
pub fn either<'a, 'py>(
    v: Option<&'a Bound<'py, PyAny>>,
    p: Option<&'a Bound<'py, PyAny>>,
) -> PyResult<(&'static str, &'a Bound<'py, PyAny>, bool)> {
    match (v, p) {
        (Some(v), None) => Ok(("v", v, true)),
        (None, Some(p)) => Ok(("p", p, false)),
        (None, None) => Err(PyTypeError::new_err("v or p has to be given beside q")),
        (Some(_), Some(_)) => Err(PyTypeError::new_err("v and p: give one of them, not both")),
    }
}

/// The inputs, for so many steps at most, and the time, as far as the system takes them.
///
/// # Errors
/// `TypeError`, `ValueError`.
pub fn inputs(
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
        let shape = format!("one for all, or one for each state, ({})", states.join(", "));
        return Err(arguments::of_shape("t", &shape, given.shape()));
    }
    let times = arguments::numbers(&given);
    times.iter().try_for_each(|&t| time(kind, Some(t)).map(drop))?;
    Ok(times)
}

/// q and v, as arrays of one shape.
pub type Pair<'py> = (Bound<'py, PyArrayDyn<f64>>, Bound<'py, PyArrayDyn<f64>>);

/// States, one after the other.
pub struct States {
    /// Their times, or that of all.
    pub times: Vec<f64>,
    /// Configurations.
    pub q: Vec<f64>,
    /// Velocities or momenta.
    pub other: Vec<f64>,
    /// The shape of the array in which they are given.
    pub shape: Vec<usize>,
}

/// The states that are given as arrays whose last dimension is n.
///
/// # Errors
/// `TypeError`, `ValueError`.
pub fn states(
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
pub fn of_space(n: usize) -> Vec<Affine> {
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
///
/// # Errors
/// `TypeError`, `ValueError`.
pub fn affine(given: &Bound<'_, PyDict>, n: usize) -> PyResult<Vec<Affine>> {
    let generator = |(name, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let name: String = name.extract()?;
        let pair = value.extract::<(Bound<'_, PyAny>, Bound<'_, PyAny>)>();
        let (linear, constant) =
            pair.map_err(|_| expected(&format!("generators: {name}"), "a pair (A, b)", &value))?;
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
///
/// # Errors
/// `TypeError`, `ValueError`.
pub fn require_constraints(kind: &dyn Kind) -> PyResult<()> {
    match kind.constraints() {
        0 => Err(PyTypeError::new_err(format!(
            "{} has no constraints: every (q, v) is a state of it, and there are no reactions",
            kind.name()
        ))),
        _ => Ok(()),
    }
}
