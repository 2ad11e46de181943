//! Runs whose steps can be looked into.

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::run::{Run, TakenUntil, Trajectory};
use crate::step::flow::velocity;
use crate::step::{Flow, Memory, State, StepError};
use crate::system::Lagrangian;

/// A run whose last step can be looked into: a [`Trajectory`], one that carries its error along
/// ([`GuardedTrajectory`](crate::tolerance::GuardedTrajectory)), and one whose input is held
/// ([`HeldInput`](crate::run::HeldInput)).
pub trait Divisible<const N: usize>: Run<N> {
    /// The type of the system that is stepped.
    type System: Lagrangian<N, Scalar = Self::Scalar>;

    /// The system.
    fn system(&self) -> &Self::System;

    /// The time of the run at which the system has its own time.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn since(&self) -> f64 {
        0.0
    }

    /// The size of the next step, and of the last where that was not shortened.
    fn step_size(&self) -> Self::Scalar;

    /// Shares of a step at which the method itself knows q and v ([`Memory::NODES`]).
    fn nodes(&self) -> &'static [f64];

    /// Calls `visit` with q and v at the nodes of the last step, of size `h`, which led from `q0`.
    fn at_nodes(
        &self,
        q0: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
        visit: impl FnMut(usize, &SVector<Self::Scalar, N>, &SVector<Self::Scalar, N>),
    );

    /// (q, v) at a share of the last step, of size `h`, which led from `q0`, by the method's own polynomial.
    fn between(
        &self,
        q0: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
        share: f64,
    ) -> Option<[SVector<Self::Scalar, N>; 2]>;

    /// The velocity of a state of the run at that time.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    fn velocity(
        &self,
        time: f64,
        state: &State<Self::Scalar, N>,
    ) -> Result<SVector<Self::Scalar, N>, StepError>;

    /// Where a step leads from where the last one began: `state` at `time`, `mean` being the mean velocity of
    /// that, `sizes` its size and that of this one.
    ///
    /// # Errors
    /// Those of the step.
    fn beginning(
        &self,
        time: f64,
        state: &State<Self::Scalar, N>,
        mean: &SVector<Self::Scalar, N>,
        sizes: [Self::Scalar; 2],
    ) -> Result<State<Self::Scalar, N>, StepError>;
}

/// A run that can leave its grid: it goes on from another state at another time, as after an impact, or ends
/// at a time.
pub trait Restartable<const N: usize>: Divisible<N> {
    /// Goes on from `state` at `time`; what the method remembers is forgotten.
    fn restart_at(&mut self, time: f64, state: State<Self::Scalar, N>);

    /// The next step with its size, as [`Until`](super::Until) says; `None` where the run is at `end` or past
    /// it, or has ended.
    fn next_until(&mut self, end: f64) -> Option<TakenUntil<Self::Scalar, N>>;
}

impl<L, M, const N: usize> Divisible<N> for Trajectory<'_, L, M, N>
where
    L: Flow<M, N>,
{
    type System = L;

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn system(&self) -> &L {
        self.system
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn step_size(&self) -> L::Scalar {
        self.step_size()
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn nodes(&self) -> &'static [f64] {
        <L::RunMemory as Memory<L, M, N>>::NODES
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn at_nodes(
        &self,
        q0: &SVector<L::Scalar, N>,
        h: L::Scalar,
        visit: impl FnMut(usize, &SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
    ) {
        self.memory.at_nodes(q0, h, visit);
    }

    fn between(
        &self,
        q0: &SVector<L::Scalar, N>,
        h: L::Scalar,
        share: f64,
    ) -> Option<[SVector<L::Scalar, N>; 2]> {
        self.memory.between(q0, h, share)
    }

    #[inline]
    fn velocity(&self, time: f64, state: &State<L::Scalar, N>) -> Result<SVector<L::Scalar, N>, StepError> {
        velocity(self.system, &self.memory, time, state)
    }

    fn beginning(
        &self,
        time: f64,
        state: &State<L::Scalar, N>,
        mean: &SVector<L::Scalar, N>,
        sizes: [L::Scalar; 2],
    ) -> Result<State<L::Scalar, N>, StepError> {
        beginning(self.system, &self.memory, time, state, mean, sizes)
    }
}

impl<L, M, const N: usize> Restartable<N> for Trajectory<'_, L, M, N>
where
    L: Flow<M, N>,
{
    fn restart_at(&mut self, time: f64, state: State<L::Scalar, N>) {
        self.restart_at(time, state);
    }

    fn next_until(&mut self, end: f64) -> Option<TakenUntil<L::Scalar, N>> {
        self.next_until(end)
    }
}

/// A step of size `elapsed` from `state` at `time`, from which the last one, of size `h`, was taken.
pub(in crate::run) fn beginning<L: Flow<M, N>, M, const N: usize>(
    system: &L,
    memory: &L::RunMemory,
    time: f64,
    state: &State<L::Scalar, N>,
    mean: &SVector<L::Scalar, N>,
    [h, elapsed]: [L::Scalar; 2],
) -> Result<State<L::Scalar, N>, StepError> {
    let time = L::Scalar::constant(time);
    system.later(time, |system| match memory.beginning(system, state, h, elapsed) {
        Some(state) => Ok(state),
        None => system.step(state, elapsed, Some(mean)).map(|step| step.state),
    })
}
