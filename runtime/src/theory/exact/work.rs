//! How much work one question may take, and why an evaluation ends it.

use core::cell::Cell;

use super::ExactError;
use crate::step::stop::Stop;

/// Where the equations of motion cannot be evaluated, or a step cannot be taken.
#[derive(Clone, Copy, Debug)]
pub(super) enum Breakdown {
    /// ∂²L/∂v² is singular.
    Degenerate { column: usize },
    /// L, R or f is NaN or infinite.
    NotFinite,
    /// Newton's method for the stages of a step does not converge: the step is too long.
    NotSolved,
    /// All evaluations are spent, or the caller ends the question.
    Exhausted,
}

/// Evaluations of the equations of motion, counted against a limit.
pub(super) struct Work<'s> {
    spent: Cell<usize>,
    limit: Cell<usize>,
    stop: Stop<'s>,
    is_stopped: Cell<bool>,
}

impl<'s> Work<'s> {
    /// All evaluations that one question may take: L and f with their derivatives, at one point each.
    pub(super) const LIMIT: usize = 1 << 22;

    pub(super) fn new(stop: Stop<'s>) -> Self {
        Self { spent: Cell::new(0), limit: Cell::new(Self::LIMIT), stop, is_stopped: Cell::new(false) }
    }

    pub(super) fn spend(&self) -> Result<(), Breakdown> {
        if self.spent.get() >= self.limit.get() {
            return Err(Breakdown::Exhausted);
        }
        if (self.spent.get() as u64).is_multiple_of(Stop::STRIDE) && self.stop.is_asked() {
            self.is_stopped.set(true);
            return Err(Breakdown::Exhausted);
        }
        self.spent.set(self.spent.get() + 1);
        Ok(())
    }

    /// `attempt` with no more than this share of all evaluations, so that others remain possible.
    pub(super) fn with_share<T>(&self, share: usize, attempt: impl FnOnce() -> T) -> T {
        self.limit.set(Self::LIMIT.min(self.spent.get() + Self::LIMIT / share));
        let result = attempt();
        self.limit.set(Self::LIMIT);
        result
    }

    /// Whether the caller has ended the question; what it fails with says nothing then.
    pub(super) fn is_stopped(&self) -> bool {
        self.is_stopped.get()
    }

    pub(super) fn spent(&self) -> usize {
        self.spent.get()
    }
}

impl Breakdown {
    /// The error, at this time of the segment.
    pub(super) fn at(self, time: f64, work: &Work<'_>) -> ExactError {
        match self {
            Self::Degenerate { column } => ExactError::DegenerateLagrangian { time, column },
            Self::NotFinite => ExactError::MotionNotFinite { time },
            Self::NotSolved => ExactError::Unresolved { steps: 0, difference: 1.0 },
            Self::Exhausted => ExactError::TooMuchWork { evaluations: work.spent(), time },
        }
    }
}
