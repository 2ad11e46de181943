//! The steps of a run and the times of its records, as Python gives them.

use numpy::PyUntypedArrayMethods;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::arguments::{array, count, numbers, of_shape, real};
use crate::offer::{ErrorAsked, Stepping};
use crate::record::Timed;

/// The arguments that say how a run is stepped.
#[derive(Clone, Copy)]
pub struct Given<'a, 'py> {
    /// The step size.
    pub h: Option<&'a Bound<'py, PyAny>>,
    /// How many steps.
    pub steps: Option<&'a Bound<'py, PyAny>>,
    /// A tolerance.
    pub tolerance: Option<&'a Bound<'py, PyAny>>,
    /// The time at the end.
    pub until: Option<&'a Bound<'py, PyAny>>,
    /// The limit of the steps.
    pub max_steps: Option<&'a Bound<'py, PyAny>>,
    /// The rule.
    pub rule: Option<&'a str>,
}

/// The share of a step that is added to the last one, in place of a step of its own, where it is no more.
const LONGER: f64 = 1.0 / 1024.0;

/// Roundings by which two times are the same.
const SAME: f64 = 8.0 * f64::EPSILON;

impl<'a> Given<'a, '_> {
    /// The steps of a run that starts at the time `origin`, up to the last of `times` where nothing else says
    /// so.
    ///
    /// # Errors
    /// `TypeError` where arguments do not go together, `ValueError` where one of them has no such value.
    pub fn read(&self, origin: f64, times: Option<&[f64]>) -> PyResult<Stepping<'a>> {
        let Self { rule, .. } = *self;
        let (h, steps) = (real("h", self.h)?, count("steps", self.steps)?);
        let tolerance = real("tolerance", self.tolerance)?;
        let until = real("until", self.until)?;
        let max_steps = count("max_steps", self.max_steps)?;
        if let Some(until) = until.filter(|until| !until.is_finite()) {
            return Err(PyValueError::new_err(format!("until: expected a finite time, got {until}")));
        }
        let last = times.and_then(|times| times.last()).copied();
        match (h, steps, tolerance, until) {
            (Some(h), steps, None, until) => {
                require_size(h)?;
                let (steps, end) = match (steps, until, last) {
                    (Some(steps), None, _) => (steps, None),
                    (None, Some(until), _) => {
                        let end = ahead("until", origin, h, until)?;
                        ((end / h - LONGER).ceil().max(0.0) as u64, Some(end))
                    }
                    (None, None, Some(last)) => (steps_to(ahead("times", origin, h, last)?, h), None),
                    (Some(_), Some(_), _) => {
                        return Err(PyTypeError::new_err(
                            "steps and until: with h give one of them, not both",
                        ));
                    }
                    (None, None, None) => {
                        return Err(PyTypeError::new_err(
                            "steps, until or a last time of times has to be given beside h",
                        ));
                    }
                };
                match max_steps {
                    Some(most) if steps > most => Err(PyValueError::new_err(format!(
                        "max_steps: the run takes {steps} steps, more than {most}; give a larger h or an earlier end"
                    ))),
                    _ => Ok(Stepping::Fixed { h, steps, end, rule }),
                }
            }
            (None, None, Some(tolerance), until) => {
                if rule.is_some() {
                    return Err(PyTypeError::new_err(
                        "rule: to a tolerance the method is chosen; leave rule out, or give h instead",
                    ));
                }
                if !(tolerance > 0.0 && tolerance.is_finite()) {
                    return Err(PyValueError::new_err(format!(
                        "tolerance: expected a number above 0, in units of q, got {tolerance}"
                    )));
                }
                let (name, end) = match (until, last) {
                    (Some(until), _) => ("until", until),
                    (None, Some(last)) => ("times", last),
                    (None, None) => {
                        return Err(PyTypeError::new_err(
                            "until or a last time of times has to be given beside tolerance",
                        ));
                    }
                };
                let until = ahead(name, origin, 1.0, end)?;
                if until == 0.0 {
                    return Err(PyValueError::new_err(format!(
                        "{name}: expected a time after the start at t = {origin}, got {end}"
                    )));
                }
                Ok(Stepping::ToError(ErrorAsked { tolerance, until, most: max_steps }))
            }
            (None, Some(_), Some(_), _) => Err(PyTypeError::new_err(
                "steps: to a tolerance the number of steps is chosen; give until, and max_steps as a limit",
            )),
            (Some(_), _, Some(_), _) => {
                Err(PyTypeError::new_err("h and tolerance: give one of them, not both"))
            }
            (None, _, None, _) => Err(PyTypeError::new_err(
                "h or tolerance has to be given: h with steps or until, or tolerance with until",
            )),
        }
    }
}

/// The step size that is given.
///
/// # Errors
/// `TypeError`, `ValueError`.
pub fn size(given: &Bound<'_, PyAny>) -> PyResult<f64> {
    let h = real("h", Some(given))?.unwrap_or(0.0);
    require_size(h).map(|()| h)
}

fn require_size(h: f64) -> PyResult<()> {
    if h == 0.0 || !h.is_finite() {
        return Err(PyValueError::new_err(format!("h: expected a finite step size other than 0, got {h}")));
    }
    Ok(())
}

/// The time from the start at `origin` to `time`, in the direction of `h`.
fn ahead(name: &str, origin: f64, h: f64, time: f64) -> PyResult<f64> {
    let elapsed = time - origin;
    if elapsed * h.signum() < 0.0 {
        let (direction, side) =
            if h > 0.0 { ("forwards", "after") } else { ("backwards, as h < 0", "before") };
        return Err(PyValueError::new_err(format!(
            "{name}: the run starts at t = {origin} and goes {direction}; expected a time {side} that, got {time}"
        )));
    }
    Ok(elapsed)
}

/// The whole steps of size `h` that it takes to `elapsed`.
fn steps_to(elapsed: f64, h: f64) -> u64 {
    let steps = elapsed / h;
    let nearest = steps.round();
    let whole = if (steps - nearest).abs() <= SAME * nearest.abs() { nearest } else { steps.ceil() };
    whole as u64
}

/// The steps as whole ones, all of size h: `why` says what takes no others.
///
/// # Errors
/// `ValueError` where the last one is shorter or longer.
pub fn whole<'a>(stepping: Stepping<'a>, why: &str) -> PyResult<Stepping<'a>> {
    match stepping {
        Stepping::Fixed { h, end: Some(end), rule, .. } => {
            let steps = (end / h).round();
            if (end - steps * h).abs() > SAME * end.abs() {
                let fits = end / steps.max(1.0);
                return Err(PyValueError::new_err(format!(
                    "until: {why} whole steps; expected a multiple of h = {h} after the start, got {end}; h = {fits} fits"
                )));
            }
            Ok(Stepping::Fixed { h, steps: steps as u64, end: None, rule })
        }
        stepping => Ok(stepping),
    }
}

/// The times that `times=` gives.
///
/// # Errors
/// `TypeError`, `ValueError`.
pub fn times(given: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let array = array("times", given)?;
    if array.shape().len() != 1 {
        return Err(of_shape("times", "(records,)", array.shape()));
    }
    let times = numbers(&array);
    match times.iter().find(|time| !time.is_finite()) {
        Some(time) => Err(PyValueError::new_err(format!("times: expected finite times, got {time}"))),
        None => Ok(times),
    }
}

/// These times, each with the time from the start at `origin`, for a run by these steps.
///
/// # Errors
/// `ValueError` where they are not those of the run, or not in its order.
pub fn timed(times: &[f64], origin: f64, stepping: &Stepping<'_>) -> PyResult<Vec<Timed>> {
    let (h, end) = match *stepping {
        Stepping::Fixed { h, end: Some(end), .. } => (h, end),
        Stepping::Fixed { h, steps, .. } => (h, h * steps as f64),
        Stepping::ToError(ErrorAsked { until, .. }) => (1.0, until),
    };
    let sign = h.signum();
    if let Some(pair) = times.windows(2).find(|pair| (pair[1] - pair[0]) * sign < 0.0) {
        return Err(PyValueError::new_err(format!(
            "times: expected them in the order of the run, got {} after {}",
            pair[1], pair[0]
        )));
    }
    let of = |&time: &f64| {
        let elapsed = ahead("times", origin, h, time)?;
        // The last one may be late by roundings of the clock.
        let late = (elapsed - end) * sign;
        if late > SAME * (origin.abs() + end.abs()) {
            return Err(PyValueError::new_err(format!(
                "times: the run ends at t = {}, before {time}; give a later end",
                origin + end
            )));
        }
        Ok(Timed { time, elapsed: if late > 0.0 { end } else { elapsed } })
    };
    times.iter().map(of).collect()
}
