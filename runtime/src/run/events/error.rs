//! Errors of a run that is watched for events.

use core::fmt;

use crate::run::between::TimeError;
use crate::step::StepError;

/// Why a run could not be watched any further. The run stands where the step began that could not be watched,
/// at the last event perhaps; one that cannot go back, for want of an end or of terminal events, at its end.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum EventError {
    /// The run's own step failed, or one within it.
    Step(StepError),
    /// An event function is NaN or infinite.
    NotFinite {
        /// Which one.
        index: usize,
        /// When.
        time: f64,
    },
    /// More than 16 events lie in one step, or 256 restarts in none: they accumulate, the function is noise
    /// there, or the state after an impact presses against the surface that it is on.
    Chattering {
        /// Which function: the surface is where it vanishes.
        index: usize,
        /// The start of the step: the last event where they accumulate.
        time: f64,
        /// The time of the run, whose state is the last good one: that start, or the end of the step where
        /// the run cannot go back.
        stands: f64,
    },
    /// Thousands of steps within one step do not tell how often the function vanishes: it is not smooth,
    /// or stays at 0 but for rounding.
    Unresolved {
        /// Which function.
        index: usize,
        /// The start of the step.
        time: f64,
    },
    /// There is no state at a time that was asked for.
    Time(TimeError),
    /// The derivatives of a control period end at the event from which the run went on.
    Restarted {
        /// Which function.
        index: usize,
        /// The time of the event.
        time: f64,
    },
    /// The function has no slope along the motion: the event's time has no derivative.
    Tangent {
        /// Which function.
        index: usize,
        /// The time of the event.
        time: f64,
    },
}

impl From<StepError> for EventError {
    fn from(error: StepError) -> Self {
        Self::Step(error)
    }
}

impl fmt::Display for EventError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step(error) => error.fmt(f),
            Self::NotFinite { index, time } => write!(
                f,
                "event function {index} is NaN or infinite near the time {time}; give one that is defined along \
                 the whole motion"
            ),
            Self::Chattering { index, time, stands } => {
                write!(
                    f,
                    "more events of function {index} than can be told apart near the time {time}: the motion rests on the \
                     surface where it vanishes, or the function is noise; the run stands at {stands}, "
                )?;
                f.write_str(if stands == time {
                    "in the last good state, from where that step began"
                } else {
                    "at the end of that step, whose events are not reported"
                })?;
                f.write_str(
                    "; go on from its state when something pushes the motion away, or, of a function that is noise, with \
                     shorter steps",
                )
            }
            Self::Unresolved { index, time } => write!(
                f,
                "event function {index} cannot be followed in the step from {time}: give a smooth one that does \
                 not stay at 0, or shorten the step"
            ),
            Self::Time(error) => error.fmt(f),
            Self::Restarted { index, time } => write!(
                f,
                "event function {index} ended the motion at {time}: the period has no derivatives beyond, which are those \
                 of the event and of the motion from there"
            ),
            Self::Tangent { index, time } => write!(
                f,
                "event function {index} has no slope along the motion at {time}: the time of the event has no \
                 derivative there"
            ),
        }
    }
}

debug_by_display!(EventError);

impl core::error::Error for EventError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Step(error) => Some(error),
            Self::Time(error) => Some(error),
            _ => None,
        }
    }
}
