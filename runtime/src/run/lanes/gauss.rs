//! Steps by Gauss rules of several members at once.

use super::{begins, state_if_sound};
use crate::rules::{Gauss, StagesInLanes};
use crate::run::{FlowInLanes, LaneRuns};
use crate::step::State;
use crate::system::ForcedLagrangianInLanes;

impl<L, const N: usize, const S: usize> FlowInLanes<Gauss<S>, N> for L
where
    L: ForcedLagrangianInLanes<N>,
{
    type Lanes<const W: usize> = StagesInLanes<L::Scalar, L::Fields<W>, N, S, W>;

    /// Sweeps go on until the last member is solved: the more there are, the more wait.
    const MOST_LANES: usize = 16;

    fn in_lanes<const W: usize>(
        systems: [&Self; W],
        starts: &[State<L::Scalar, N>; W],
        h: L::Scalar,
    ) -> Self::Lanes<W> {
        let mut lanes = StagesInLanes::new(L::fields(systems), h);
        for (lane, (system, start)) in systems.into_iter().zip(starts).enumerate() {
            lanes.put(lane, system, start, begins(lane, system, start, h));
        }
        lanes
    }

    fn refill_lanes<const W: usize>(
        lanes: &mut Self::Lanes<W>,
        systems: [&Self; W],
        starts: &[Option<State<L::Scalar, N>>; W],
        h: L::Scalar,
    ) {
        lanes.gather(L::fields(systems));
        for (lane, (system, start)) in systems.into_iter().zip(starts).enumerate() {
            if let Some(start) = start {
                lanes.put(lane, system, start, begins(lane, system, start, h));
            }
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn advance_in_lanes<const W: usize>(lanes: &mut Self::Lanes<W>, systems: [&Self; W], steps: u64) {
        lanes.advance(systems, steps);
    }

    fn leave_unsolved<const W: usize>(lanes: &mut Self::Lanes<W>, error: f64, steps: u64) {
        lanes.leave(error, steps);
    }

    #[inline]
    fn state_of_lane<const W: usize>(lanes: &Self::Lanes<W>, lane: usize) -> Option<State<L::Scalar, N>> {
        let (q, p, is_sound) = lanes.standing();
        state_if_sound(q, p, is_sound, lane)
    }
}

impl<L, const N: usize, const S: usize, const W: usize> LaneRuns<'_, L, Gauss<S>, N, W>
where
    L: ForcedLagrangianInLanes<N>,
{
    /// How many steps members have taken by their own runs, of all members together: those whose sweeps leave
    /// the usual path, and the first of members that are put in while most others go on. Where they are many,
    /// lanes gain little.
    #[must_use]
    pub fn steps_alone(&self) -> u64 {
        self.lanes.steps_alone()
    }
}
