//! W runs at once: each member a system of its own from a state of its own, all by one method and step size.
//!
//! Each operation is done for all members, in plain arrays and loops ([`Members`]): as fast as the
//! instructions allow that the caller is compiled for. The states are bit by bit those of each member's own
//! run.

mod explicit;
mod gauss;
mod midpoint;

use core::marker::PhantomData;

use nalgebra::SVector;

use crate::numbers::members::member;
use crate::numbers::{Elementary, Mask, MemberVector, Members, Scalar};
use crate::rules::steps_until;
use crate::run::{Checkpoint, Course, Explicit};
use crate::step::{Flow, State};
use crate::system::Lagrangian;

/// An explicit system whose force is known of several members at once: what `lanes = explicit` generates.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not stepped in lanes",
    label = "the force of `{Self}` is not written for several members at once",
    note = "add `lanes = explicit` to the attribute: `#[rayleigh_system(rule = trapezoidal, lanes = explicit)]`"
)]
pub trait ExplicitInLanes<const N: usize>: Explicit<N, Scalar: Elementary> {
    /// The fields of W systems that the force reads.
    type Fields<const W: usize>: Copy + core::fmt::Debug;

    /// Gathers the fields that the force reads.
    fn fields<const W: usize>(systems: [&Self; W]) -> Self::Fields<W>;

    /// The fields of [`later`](crate::Lagrangian::later) of each system: at its own time plus `elapsed`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn later_in_lanes<const W: usize>(
        fields: &Self::Fields<W>,
        elapsed: &Members<Self::Scalar, W>,
    ) -> Self::Fields<W> {
        let _ = elapsed;
        *fields
    }

    /// [`velocity_momenta`](Explicit::velocity_momenta) of each member, p0 and p1, to the last bit.
    fn velocity_momenta_in_lanes<const W: usize>(
        fields: &Self::Fields<W>,
        v: &MemberVector<Self::Scalar, N, W>,
        h: Self::Scalar,
    ) -> [MemberVector<Self::Scalar, N, W>; 2];

    /// [`configuration_force`](Explicit::configuration_force) of each member, whose time `fields` has, to the
    /// last bit.
    fn configuration_force_in_lanes<const W: usize>(
        fields: &Self::Fields<W>,
        q: &MemberVector<Self::Scalar, N, W>,
    ) -> MemberVector<Self::Scalar, N, W>;
}

/// A system that method `M` steps in lanes.
pub trait FlowInLanes<M, const N: usize>: Flow<M, N> {
    /// W members on their way: their states, and all that a step asks for.
    type Lanes<const W: usize>: Copy + core::fmt::Debug;

    /// The largest W at which a member's step still got cheaper, on the machines measured.
    const MOST_LANES: usize = 32;

    /// The members at their starts. One that no run can start from, or whose method cannot be prepared, has
    /// no state.
    fn in_lanes<const W: usize>(
        systems: [&Self; W],
        starts: &[State<Self::Scalar, N>; W],
        h: Self::Scalar,
    ) -> Self::Lanes<W>;

    /// Members put into lanes at their starts, where there is one; the others stay as they are. `systems` are
    /// those of all lanes from now on.
    fn refill_lanes<const W: usize>(
        lanes: &mut Self::Lanes<W>,
        systems: [&Self; W],
        starts: &[Option<State<Self::Scalar, N>>; W],
        h: Self::Scalar,
    );

    /// From each member's start on, what [`Memory::leave_unsolved`](crate::step::Memory::leave_unsolved)
    /// says.
    fn leave_unsolved<const W: usize>(lanes: &mut Self::Lanes<W>, error: f64, steps: u64) {
        let _ = (lanes, error, steps);
    }

    /// All members on by this many steps: those that were put into the lanes, with their systems.
    fn advance_in_lanes<const W: usize>(lanes: &mut Self::Lanes<W>, systems: [&Self; W], steps: u64);

    /// The state of one member; nothing where its own run has to tell what became of it.
    fn state_of_lane<const W: usize>(lanes: &Self::Lanes<W>, lane: usize) -> Option<State<Self::Scalar, N>>;
}

/// W runs at once, by method `M` with one step size. Views are systems as well, each with the input that it
/// holds and at its own time: that of the view and of the steps that its run has taken, at which
/// [`velocity`](Self::velocity) and [`energy`](Self::energy) ask it.
///
/// A member that fails leaves the others as they are, and has no state from then on: its own run,
/// `system.by(method, h).run(start)`, says why.
///
/// ```
/// use dalembert::run::LaneRuns;
/// use dalembert::{Discretise, Splitting, State, rayleigh_system};
///
/// #[rayleigh_system(rule = trapezoidal, lanes = explicit)]
/// fn pendulum(q: [f64; 1], v: [f64; 1], length: f64, r: f64) -> (f64, f64) {
///     (0.5 * length * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
/// }
///
/// let pendulums = [1.0, 1.1, 1.2, 1.3].map(|length| Pendulum { length, r: 0.1 });
/// let systems = pendulums.each_ref();
/// let start = State { q: [1.0].into(), p: [0.0].into() };
/// let mut runs = LaneRuns::new(Splitting::blanes_moan_6(), systems, &[start; 4], 0.5);
/// runs.advance(1000);
/// for (lane, system) in systems.into_iter().enumerate() {
///     let alone = system.by(Splitting::blanes_moan_6(), 0.5).run(start).nth(999).unwrap()?.state;
///     assert_eq!(runs.state(lane), Some(alone));
/// }
/// # Ok::<(), dalembert::StepError>(())
/// ```
pub struct LaneRuns<'a, L, M, const N: usize, const W: usize>
where
    L: FlowInLanes<M, N>,
{
    systems: [&'a L; W],
    h: L::Scalar,
    lanes: L::Lanes<W>,
    /// Steps since each member was put into its lane.
    taken: [u64; W],
    method: PhantomData<M>,
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
        let lanes = L::in_lanes(systems, starts, h);
        Self { systems, h, lanes, taken: [0; W], method: PhantomData }
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
        let mut arriving = [None; W];
        for (lane, system) in systems.into_iter().enumerate() {
            if let Some(system) = system {
                self.systems[lane] = system;
                self.taken[lane] = 0;
                arriving[lane] = Some(starts[lane]);
            }
        }
        L::refill_lanes(&mut self.lanes, self.systems, &arriving, self.h);
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
        L::leave_unsolved(&mut self.lanes, error, steps_until(time, self.h.widen()));
        self
    }

    /// All runs on by this many steps: bit by bit the same, at once or in parts.
    ///
    /// Inlined into its caller, so that it is compiled for the caller's instruction set.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub fn advance(&mut self, steps: u64) {
        L::advance_in_lanes(&mut self.lanes, self.systems, steps);
        for taken in &mut self.taken {
            *taken = taken.saturating_add(steps);
        }
    }

    /// The state of the run in this lane: that of the scalar run after as many steps, to the last bit.
    /// Nothing if that run would have ended with an error by now, if it alone can tell (an explicit step
    /// whose rounding has to be measured, a matrix that has to be factored otherwise), or if there is no such
    /// lane.
    #[inline]
    #[must_use]
    pub fn state(&self, lane: usize) -> Option<State<L::Scalar, N>> {
        if lane < W { L::state_of_lane(&self.lanes, lane) } else { None }
    }

    /// The time of the run in this lane: h × the steps since it was put there. Nothing if there is no such
    /// lane.
    #[must_use]
    pub fn time(&self, lane: usize) -> Option<f64> {
        self.taken.get(lane).map(|&taken| taken as f64 * self.h.widen())
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

impl<L: FlowInLanes<M, N>, M, const N: usize, const W: usize> Clone for LaneRuns<'_, L, M, N, W> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: FlowInLanes<M, N>, M, const N: usize, const W: usize> Copy for LaneRuns<'_, L, M, N, W> {}

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

/// The state of the member in a lane, if it is sound and its numbers are finite.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn state_if_sound<T: Scalar, const N: usize, const W: usize>(
    q: &MemberVector<T, N, W>,
    p: &MemberVector<T, N, W>,
    is_sound: Mask<W>,
    lane: usize,
) -> Option<State<T, N>> {
    let state = State { q: member(q, lane), p: member(p, lane) };
    // 0·x is 0 for every finite x and NaN for the others.
    let mut poison = T::zero();
    for entry in state.q.iter().chain(state.p.iter()) {
        poison += *entry * T::zero();
    }
    let is_sound = is_sound.0.get(lane).is_some_and(|&is_sound| is_sound);
    (is_sound && poison == T::zero()).then_some(state)
}
