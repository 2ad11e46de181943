//! W runs at once: each member a system of its own from a state of its own, all by one method and step size.
//!
//! Each operation is done for all members, in plain arrays and loops ([`Members`]): as fast as the
//! instructions allow that the caller is compiled for. The states are bit by bit those of each member's own
//! run.

mod explicit;
mod midpoint;
mod told;

use nalgebra::SVector;

use crate::numbers::{MemberVector, Scalar};
use crate::rules::steps_until;
use crate::run::{Checkpoint, Course, Explicit};
use crate::step::{FlowInLanes, LaneRuns, State};
use crate::system::{Gathered, Lagrangian};
pub use told::ToldRun;

/// An explicit system whose force is known of several members at once: what `lanes = explicit` generates.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not stepped in lanes",
    label = "the force of `{Self}` is not written for several members at once",
    note = "add `lanes = explicit` to the attribute: `#[rayleigh_system(rule = trapezoidal, lanes = explicit)]`"
)]
pub trait ExplicitInLanes<const N: usize>: Gathered<N> + Explicit<N> {
    /// [`velocity_momenta`](Explicit::velocity_momenta) of each member, p0 and p1, to the last bit.
    fn velocity_momenta_in_lanes<'s, const W: usize>(
        fields: &Self::Fields<'s, W>,
        v: &MemberVector<Self::Scalar, N, W>,
        h: Self::Scalar,
    ) -> [MemberVector<Self::Scalar, N, W>; 2]
    where
        Self: 's;

    /// [`configuration_force`](Explicit::configuration_force) of each member, whose time `fields` has, to the
    /// last bit.
    fn configuration_force_in_lanes<'s, const W: usize>(
        fields: &Self::Fields<'s, W>,
        q: &MemberVector<Self::Scalar, N, W>,
    ) -> MemberVector<Self::Scalar, N, W>
    where
        Self: 's;
}

impl<'a, L, M, const N: usize, const W: usize> LaneRuns<'a, L, M, N, W>
where
    L: FlowInLanes<M, N>,
{
    /// One run for each system, from the state of the same index.
    ///
    /// The value is large: room for 2·N²·S·W numbers by a [`Splitting`](crate::Splitting) of S drifts, of
    /// which N·S·W are used where M and C are diagonal. How many lanes pay depends on the registers of the
    /// machine and, for many coordinates, on its caches.
    #[must_use]
    pub fn new(method: M, systems: [&'a L; W], starts: &[State<L::Scalar, N>; W], h: L::Scalar) -> Self {
        let _ = method;
        let mut runs = Self::empty(systems, h);
        for (lane, start) in starts.iter().enumerate() {
            runs.put(lane, start, begins(lane, systems[lane], start, h));
        }
        runs
    }

    /// Other runs, from the states of the same index, in the lanes that have a system here, as they would be
    /// in [`new`](Self::new); the runs in the other lanes go on.
    ///
    /// ```
    /// use dalembert::run::LaneRuns;
    /// use dalembert::{Discretise, Splitting, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = trapezoidal, lanes = explicit)]
    /// fn pendulum(q: [f64; 1], v: [f64; 1], length: f64) -> f64 {
    ///     0.5 * length * v[0] * v[0] + q[0].cos()
    /// }
    ///
    /// let pendulums = [1.0, 1.1, 1.2].map(|length| Pendulum { length });
    /// let start = State { q: [1.0].into(), p: [0.0].into() };
    /// let mut runs = LaneRuns::new(Splitting::blanes_moan_6(), [&pendulums[0], &pendulums[1]], &[start; 2], 0.5);
    /// runs.advance(10);
    /// runs.refill([None, Some(&pendulums[2])], &[start; 2]);
    /// runs.advance(20);
    /// let alone = |k: usize, steps: usize| {
    ///     pendulums[k].by(Splitting::blanes_moan_6(), 0.5).run(start).nth(steps - 1).unwrap().map(|step| step.state)
    /// };
    /// assert_eq!(runs.state(0), Some(alone(0, 30)?));
    /// assert_eq!(runs.state(1), Some(alone(2, 20)?));
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    pub fn refill(&mut self, systems: [Option<&'a L>; W], starts: &[State<L::Scalar, N>; W]) {
        for (system, arriving) in self.systems.iter_mut().zip(systems) {
            *system = arriving.unwrap_or(system);
        }
        self.fields = L::fields(self.systems);
        for (lane, start) in starts.iter().enumerate().filter(|(lane, _)| systems[*lane].is_some()) {
            self.put(lane, start, begins(lane, self.systems[lane], start, self.h));
        }
    }

    /// Solves the stages of a Gauss rule no further than an error of `error` at the time `time` from each
    /// member's start asks for, of those that are put into lanes later too:
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
    /// let runs = LaneRuns::new(Gauss::<6>, pendulums.each_ref(), &[start; 4], 0.5);
    /// let mut runs = runs.solved_for(1e-6, 20.0);
    /// runs.advance(40);
    /// for (lane, pendulum) in pendulums.iter().enumerate() {
    ///     let alone = pendulum.by(Gauss::<6>, 0.5).run(start).solved_for(1e-6, 20.0).nth(39).unwrap()?;
    ///     assert_eq!(runs.state(lane), Some(alone.state));
    /// }
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    #[must_use = "the runs given are consumed"]
    pub fn solved_for(mut self, error: f64, time: f64) -> Self {
        L::leave_unsolved(&mut self.kept, error, steps_until(time, self.h.widen()));
        self
    }

    /// All runs on by this many steps: bit by bit the same, at once or in parts.
    ///
    /// Inlined into its caller, so that it is compiled for the caller's instruction set.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn advance(&mut self, steps: u64) {
        L::advance_in_lanes(self, steps);
        self.clocks.count(steps);
    }

    /// How many steps members have taken by their own runs, of all members together: first steps, and those
    /// that leave the usual path. Where they are many, lanes gain little.
    #[must_use]
    pub fn steps_alone(&self) -> u64 {
        self.alone
    }

    /// The state of the run in this lane: that of the scalar run after as many steps, to the last bit.
    /// Nothing if that run would have ended with an error by now, if it alone can tell (an explicit step
    /// whose rounding has to be measured, a matrix that has to be factored otherwise), or if there is no such
    /// lane.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn state(&self, lane: usize) -> Option<State<L::Scalar, N>> {
        let state = self.values(lane);
        // 0·x is 0 for every finite x and NaN for the others.
        let zero = L::Scalar::constant(0.0);
        let mut poison = zero;
        for entry in state.q.iter().chain(state.p.iter()) {
            poison += *entry * zero;
        }
        let is_sound = self.is_sound.0.get(lane).is_some_and(|&is_sound| is_sound);
        (is_sound && poison == zero).then_some(state)
    }

    /// The time of the run in this lane: h × the steps since it was put there. Nothing if there is no such
    /// lane.
    #[must_use]
    pub fn time(&self, lane: usize) -> Option<f64> {
        self.clocks.times(0, self.h).0.get(lane).copied()
    }

    /// The velocity of the run in this lane, of its system as that is now. Nothing where there is no
    /// [`state`](Self::state), or no velocity of it.
    #[must_use]
    pub fn velocity(&self, lane: usize) -> Option<SVector<L::Scalar, N>> {
        self.at_present(lane, |system, state| state.velocity(system).ok())
    }

    /// The energy of the run in this lane, of its system as that is now. Nothing where there is no
    /// [`state`](Self::state), or no velocity of it.
    #[must_use]
    pub fn energy(&self, lane: usize) -> Option<L::Scalar> {
        self.at_present(lane, |system, state| state.energy(system).ok())
    }

    fn at_present<T>(
        &self,
        lane: usize,
        ask: impl FnOnce(&L, &State<L::Scalar, N>) -> Option<T>,
    ) -> Option<T> {
        let (state, time) = (self.state(lane)?, self.time(lane)?);
        self.systems.get(lane)?.later(L::Scalar::constant(time), |system| ask(system, &state))
    }
}

/// Whether the run in a lane begins from `start`, and its clock needs no watching. Of the first lane slopes
/// are looked at too: they cost as much as some steps of all.
pub(crate) fn begins<L: Lagrangian<N>, const N: usize>(
    lane: usize,
    system: &L,
    start: &State<L::Scalar, N>,
    h: L::Scalar,
) -> bool {
    let mut course = if lane == 0 { Course::Starting } else { Course::Beginning };
    start.require_finite().is_ok()
        && course.require(system, &Checkpoint::new(h, *start)).is_ok()
        && course == Course::Open
}
