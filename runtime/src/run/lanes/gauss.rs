//! Steps by Gauss rules of several members at once.

use super::{begins, state_if_sound};
use crate::numbers::Scalar;
use crate::rules::{Gauss, StagesInLanes, steps_until};
use crate::run::{InLanes, LaneRuns};
use crate::step::State;
use crate::system::ForcedLagrangianInLanes;

impl<L, const N: usize, const S: usize> InLanes<Gauss<S>, N> for L
where
    L: ForcedLagrangianInLanes<N>,
{
    type Lanes<const W: usize> = StagesInLanes<L::Scalar, L::Fields<W>, N, S, W>;

    fn in_lanes<const W: usize>(
        systems: [&Self; W],
        starts: &[State<L::Scalar, N>; W],
        h: L::Scalar,
    ) -> Self::Lanes<W> {
        let mut lanes = StagesInLanes::new(L::fields(systems), h);
        for (lane, (system, start)) in systems.into_iter().zip(starts).enumerate() {
            lanes.put(lane, start, begins(system, start, h));
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
                lanes.put(lane, start, begins(system, start, h));
            }
        }
    }

    #[inline(always)]
    fn advance_in_lanes<const W: usize>(lanes: &mut Self::Lanes<W>, systems: [&Self; W], steps: u64) {
        lanes.advance(systems, steps);
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
    /// Solves the stages no further than an error of `error` at the time `time` from each member's start asks
    /// for, of those that are put into lanes later too:
    /// [`Trajectory::solved_for`](crate::Trajectory::solved_for) of each, which says what it costs.
    ///
    /// ```
    /// use dalembert::run::LaneRuns;
    /// use dalembert::{Discretise, Gauss, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = gauss, lanes = gauss)]
    /// fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
    /// }
    ///
    /// let pendulums = [0.0, 0.01, 0.02, 0.03].map(|r| Pendulum { r });
    /// let start = State { q: [1.0].into(), p: [0.0].into() };
    /// let mut runs = LaneRuns::new(Gauss::<6>, pendulums.each_ref(), &[start; 4], 0.5).solved_for(1e-6, 20.0);
    /// runs.advance(40);
    /// for (lane, pendulum) in pendulums.iter().enumerate() {
    ///     let alone = pendulum.by(Gauss::<6>, 0.5).run(start).solved_for(1e-6, 20.0).nth(39).unwrap()?;
    ///     assert_eq!(runs.state(lane), Some(alone.state));
    /// }
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    #[must_use = "the runs given are consumed"]
    pub fn solved_for(mut self, error: f64, time: f64) -> Self {
        self.lanes.leave(error, steps_until(time, self.h.widen()));
        self
    }

    /// How many steps members have taken by their own runs, of all members together: the first of each, and
    /// those whose sweeps leave the usual path. Where they are many, lanes gain little.
    #[must_use]
    pub fn steps_alone(&self) -> u64 {
        self.lanes.steps_alone()
    }
}
