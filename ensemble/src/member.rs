//! A member's records, its end, and why it failed.

use core::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

use dalembert::nalgebra::SVector;
use dalembert::run::events::EventError;
use dalembert::system::Scalar;
use dalembert::tolerance::ToleranceError;
use dalembert::{Lagrangian, State, StepError};

/// A member at a time: what a reduction sees.
#[derive(Debug)]
pub struct Record<'m, L: Lagrangian<N>, const N: usize> {
    /// Its number.
    pub number: u64,
    /// Its system, as it is at the start where it takes the time.
    pub system: &'m L,
    /// Steps taken.
    pub steps: u64,
    /// The time of the state, from 0 at the start.
    pub time: f64,
    /// The state.
    pub state: State<L::Scalar, N>,
    /// The event function that vanishes there, of a record of an event: of a [`Stepping`](crate::Stepping)
    /// that looks for events.
    pub event: Option<usize>,
}

impl<L: Lagrangian<N>, const N: usize> Clone for Record<'_, L, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Lagrangian<N>, const N: usize> Copy for Record<'_, L, N> {}

impl<L: Lagrangian<N>, const N: usize> Record<'_, L, N> {
    /// The velocity, of the system as it is at the time of the state.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub fn velocity(&self) -> Result<SVector<L::Scalar, N>, StepError> {
        self.system.later(Scalar::constant(self.time), |system| self.state.velocity(system))
    }

    /// The energy, of the system as it is at the time of the state.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    pub fn energy(&self) -> Result<L::Scalar, StepError> {
        self.system.later(Scalar::constant(self.time), |system| self.state.energy(system))
    }
}

/// A member at the end of its run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End<S, const N: usize> {
    /// Its number.
    pub number: u64,
    /// The time.
    pub time: f64,
    /// The state.
    pub state: State<S, N>,
}

/// Why a member is not what was asked for.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum MemberError {
    /// A step failed, or the making of the start.
    Step(StepError),
    /// No method was chosen for the tolerance, or no run that was tried keeps it.
    Tolerance(ToleranceError),
    /// Its events cannot be followed.
    Event(EventError),
    /// L, R or f panicked, or the function that makes the member.
    Panicked,
}

/// Does `work` of a member; an error where it panics, so that the others go on.
pub(crate) fn caught<T>(work: impl FnOnce() -> T) -> Result<T, MemberError> {
    // What it leaves half done is looked at no more.
    catch_unwind(AssertUnwindSafe(work)).map_err(|_| MemberError::Panicked)
}

impl fmt::Display for MemberError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step(error) => error.fmt(f),
            Self::Tolerance(error) => error.fmt(f),
            Self::Event(error) => error.fmt(f),
            Self::Panicked => f.write_str(
                "L, R or f panicked, or what makes the member; run it alone to see where, and return an error \
                 instead",
            ),
        }
    }
}

impl fmt::Debug for MemberError {
    /// The text of [`Display`](fmt::Display), which `main` and `unwrap` print.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl core::error::Error for MemberError {}

impl From<StepError> for MemberError {
    fn from(error: StepError) -> Self {
        Self::Step(error)
    }
}

impl From<EventError> for MemberError {
    fn from(error: EventError) -> Self {
        match error {
            EventError::Step(error) => Self::Step(error),
            error => Self::Event(error),
        }
    }
}

impl From<ToleranceError> for MemberError {
    fn from(error: ToleranceError) -> Self {
        match error {
            ToleranceError::Step(error) => Self::Step(error),
            error => Self::Tolerance(error),
        }
    }
}

/// A member that is not what was asked for.
#[derive(Clone, Copy, PartialEq)]
pub struct Failure<S, const N: usize> {
    /// Its number.
    pub number: u64,
    /// Why.
    pub error: MemberError,
    /// Its last good state, `None` where it has no start.
    pub last: Option<End<S, N>>,
}

impl<S, const N: usize> fmt::Display for Failure<S, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { number, error, last } = self;
        match last {
            Some(End { time, .. }) => write!(f, "member {number}, at t = {time}: {error}"),
            None => write!(f, "member {number} has no start: {error}"),
        }
    }
}

impl<S, const N: usize> fmt::Debug for Failure<S, N> {
    /// The text of [`Display`](fmt::Display), which `main` and `unwrap` print.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl<S, const N: usize> core::error::Error for Failure<S, N> {}
