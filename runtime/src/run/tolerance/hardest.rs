//! The hardest step of a run: of those looked at the one that erred most. A start shows nothing of a passage
//! that comes later, as of a pericentre, so that the next run's steps are tried there as well.

use crate::numbers::Scalar;
use crate::step::State;

/// The step that erred most, and the sum of what all erred by.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Hardest<S: Scalar, const N: usize> {
    /// The state before it.
    pub(super) state: State<S, N>,
    /// The time there, and the step size.
    pub(super) elapsed: f64,
    pub(super) span: f64,
    /// Its local error, in the norm of the promise; infinite where it has none.
    local: f64,
    /// The local errors of all steps, so many.
    sum: f64,
    steps: f64,
}

/// The growth of errors where one is infinite, so that it is not known.
const UNKNOWN: f64 = 10.0;

impl<S: Scalar, const N: usize> Hardest<S, N> {
    /// Before any step has been looked at.
    pub(super) fn new(state: State<S, N>, span: f64) -> Self {
        Self { state, elapsed: 0.0, span, local: 0.0, sum: 0.0, steps: 0.0 }
    }

    /// Adds the last of so many `steps`, of size `span`, which erred by `local`; with those before it that
    /// were not looked at it makes so many `times` its error.
    pub(super) fn add(
        &mut self,
        state: &State<S, N>,
        [elapsed, span]: [f64; 2],
        local: f64,
        [times, steps]: [f64; 2],
    ) {
        self.steps += steps;
        if local.is_finite() {
            self.sum += local * times;
        }
        if local > self.local {
            *self = Self { state: *state, elapsed, span, local, ..*self };
        }
    }

    /// The share of the steps that would make the error of all if each erred as the hardest one does.
    pub(super) fn share(&self) -> f64 {
        let least = 1.0 / self.steps.max(1.0);
        let share = self.sum / self.local * least;
        if share.is_finite() { share.clamp(least, 1.0) } else { least }
    }

    /// By how much errors have grown on the way where they have come to `largest` together.
    pub(super) fn growth(&self, largest: f64) -> f64 {
        let growth = largest / self.sum;
        if growth.is_finite() { growth.max(1.0) } else { UNKNOWN }
    }
}
