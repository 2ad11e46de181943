//! The clocks of several members: each stands as many steps after its start as it has taken.

use crate::numbers::{Mask, Members, Scalar};

/// How many steps each of W members has taken.
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

    /// Counts a step of the members of `whose`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn follow(&mut self, whose: Mask<W>) {
        for lane in 0..W {
            self.taken[lane] += u64::from(whose.0[lane]);
        }
    }

    /// Counts a step of one member.
    pub(crate) fn follow_one(&mut self, lane: usize) {
        self.taken[lane] += 1;
    }

    /// The time of each since its start.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn times<T: Scalar>(&self, h: T) -> Members<f64, W> {
        Members(self.taken.map(|taken| time(taken, h)))
    }

    /// [`times`](Self::times) in the numbers of the system.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn elapsed<T: Scalar>(&self, h: T) -> Members<T, W> {
        Members(self.times(h).0.map(T::constant))
    }

    /// The time of one member since its start.
    #[inline]
    pub(crate) fn elapsed_of<T: Scalar>(&self, lane: usize, h: T) -> T {
        T::constant(time(self.taken[lane], h))
    }

    /// [`elapsed_of`](Self::elapsed_of) at the start of the member's last step.
    #[inline]
    pub(crate) fn elapsed_before<T: Scalar>(&self, lane: usize, h: T) -> T {
        T::constant(time(self.taken[lane].saturating_sub(1), h))
    }
}
