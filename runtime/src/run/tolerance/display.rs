//! `Display` of trials, choices, breaches and refusals.

use core::fmt;

use super::{Breach, Choice, Chosen, ToleranceError, Trial};
use crate::system::Lagrangian;

impl fmt::Display for Trial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { method, step_size, evaluations, expected } = self;
        write!(f, "{method}: h = {step_size:.3e}, {evaluations:.2e} evaluations, error {expected:.1e}")
    }
}

impl<L: Lagrangian<N>, M, const N: usize> fmt::Display for Choice<'_, L, M, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Chosen { method, step_size, steps, tolerance, expected, trials, .. } = &self.chosen;
        write!(
            f,
            "{method}, h = {step_size:.4e}, {steps} steps: error {expected:.1e} expected, {tolerance:.1e} asked for"
        )?;
        if let Some(slack) = self.chosen.slack() {
            write!(f, ", stages solved to {slack:.1e} a step")?;
        }
        trials.iter().flatten().try_for_each(|trial| write!(f, "\n  {trial}"))
    }
}

impl<L: Lagrangian<N>, M, const N: usize> fmt::Debug for Choice<'_, L, M, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Display for ToleranceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Request { time, tolerance } => {
                write!(f, "time {time} and tolerance {tolerance} have to be finite and above 0")
            }
            Self::OutOfReach { closest } => {
                f.write_str("no method reaches the tolerance; ask for less, or for a shorter time")?;
                match closest {
                    Some(trial) => write!(f, "; the closest: {trial}"),
                    None => f.write_str("; none can take a step"),
                }
            }
            Self::LongestStep { step_size } => {
                write!(f, "the longest step {step_size} has to be a number above 0")
            }
            Self::MostEvaluations { most } => {
                write!(f, "the most evaluations {most} have to be a number above 0")
            }
            Self::Break { time } => {
                write!(f, "the system cannot break at the time {time}: give finite times")
            }
            Self::TooManySteps { needed, steps, most, rate } => {
                write!(f, "the error takes {steps:.1e} steps, and {most:.1e} are allowed")?;
                allow_more(f, needed, *rate, "at_most")
            }
            Self::TooManyEvaluations { needed, most, rate } => {
                write!(
                    f,
                    "the error takes more than the {most:.1e} evaluations of the forces that are allowed"
                )?;
                allow_more(f, needed, *rate, "at_most_evaluations")
            }
            Self::NothingMoves { looks, apart } => write!(
                f,
                "the system starts at rest, and at {looks} times, {apart:.1e} apart, no force moves it: nothing \
                 says how long steps may be. Say when its force sets in by `breaking_at`, or how long it lasts by \
                 `longest_step`"
            ),
            Self::NotOffered { method } => {
                write!(f, "the system does not offer the method of the run: {method}; list its rule")
            }
            Self::Stopped => f.write_str("the caller stopped it before there was a run that keeps the error"),
            Self::Step(error) => write!(f, "no run begins, or comes to its end: {error}"),
            Self::Breach(breach) => {
                let Breach { time, expected, tolerance, .. } = breach;
                write!(
                    f,
                    "no run that was tried keeps the error of {tolerance:.1e}; at t = {time:.4} the last one "
                )?;
                if expected.is_finite() {
                    write!(f, "comes to {expected:.1e}")?;
                } else {
                    f.write_str("meets a step that errs by no number, as near a pole of the coordinates or where a mass vanishes")?;
                }
                f.write_str("; where the force or a slope jumps with time, give the times by `breaking_at`")
            }
        }
    }
}

/// The cures of a run that takes more than is allowed by this method.
fn allow_more(f: &mut fmt::Formatter<'_>, needed: &Trial, rate: f64, by: &str) -> fmt::Result {
    write!(
        f,
        ": {needed}. At the start the motion changes at the rate {rate:.1e}. Allow more by `{by}`, ask for less, \
         or for a shorter time; where the rate is that of a pole of the coordinates, take others"
    )
}

impl fmt::Display for Breach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "at t = {:.4} an error of {:.1e} is to be expected, {:.1e} was asked for; start again and ask for {:.1e}",
            self.time, self.expected, self.tolerance, self.instead
        )
    }
}

debug_by_display!(ToleranceError);

impl core::error::Error for ToleranceError {}
