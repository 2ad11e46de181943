//! The clocks of several members: each stands as many steps after its start as it has taken.

use crate::numbers::{Members, Scalar};

/// How many steps each of W members has taken when a call begins; all take those of the call together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clocks<const W: usize> {
    taken: [u64; W],
}

/// h × the number of steps, as [`Checkpoint::time`](crate::run::Checkpoint::time) of a run with one step
/// size.
#[cfg_attr(not(debug_assertions), inline(always))]
fn time<T: Scalar>(taken: u64, h: T) -> f64 {
    if taken == 0 { 0.0 } else { h.widen() * taken as f64 }
}

impl<const W: usize> Clocks<W> {
    /// All members at their starts.
    pub(crate) fn new() -> Self {
        Self { taken: [0; W] }
    }

    /// Puts the clock of one member back to its start.
    pub(crate) fn restart(&mut self, lane: usize) {
        self.taken[lane] = 0;
    }

    /// Counts the steps of a call.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn count(&mut self, steps: u64) {
        for taken in &mut self.taken {
            *taken = taken.saturating_add(steps);
        }
    }

    /// The time of each member since its start, so many steps into the call.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn times<T: Scalar>(&self, steps: u64, h: T) -> Members<f64, W> {
        Members(self.taken.map(|taken| time(taken.wrapping_add(steps), h)))
    }

    /// [`times`](Self::times) in the numbers of the system.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn elapsed<T: Scalar>(&self, steps: u64, h: T) -> Members<T, W> {
        Members(self.times(steps, h).0.map(T::constant))
    }
}
