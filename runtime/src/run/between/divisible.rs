//! Runs whose steps can be looked into.

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::run::{Run, Trajectory};
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

    /// The size of the last step, and of the next.
    fn step_size(&self) -> Self::Scalar;

    /// Shares of a step at which the method itself knows q and v ([`Memory::NODES`]).
    fn nodes(&self) -> &'static [f64];

    /// Calls `visit` with q and v at the nodes of the last step, which led from `q0`.
    fn at_nodes(
        &self,
        q0: &SVector<Self::Scalar, N>,
        visit: impl FnMut(usize, &SVector<Self::Scalar, N>, &SVector<Self::Scalar, N>),
    );

    /// (q, v) at a share of the last step, which led from `q0`, by the method's own polynomial.
    fn between(&self, q0: &SVector<Self::Scalar, N>, share: f64) -> Option<[SVector<Self::Scalar, N>; 2]>;

    /// The velocity of a state of the run at that time.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    fn velocity(
        &self,
        time: f64,
        state: &State<Self::Scalar, N>,
    ) -> Result<SVector<Self::Scalar, N>, StepError>;

    /// Where a step of size `elapsed` leads from where the last one began: `state` at `time`, `mean` being
    /// the mean velocity of that.
    ///
    /// # Errors
    /// Those of the step.
    fn beginning(
        &self,
        time: f64,
        state: &State<Self::Scalar, N>,
        mean: &SVector<Self::Scalar, N>,
        elapsed: Self::Scalar,
    ) -> Result<State<Self::Scalar, N>, StepError>;
}

/// A run that goes on from another state at another time, as after an impact.
pub trait Restartable<const N: usize>: Divisible<N> {
    /// Goes on from `state` at `time`; what the method remembers is forgotten.
    fn restart_at(&mut self, time: f64, state: State<Self::Scalar, N>);
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
        visit: impl FnMut(usize, &SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
    ) {
        self.memory.at_nodes(q0, self.step_size(), visit);
    }

    fn between(&self, q0: &SVector<L::Scalar, N>, share: f64) -> Option<[SVector<L::Scalar, N>; 2]> {
        self.memory.between(q0, self.step_size(), share)
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
        elapsed: L::Scalar,
    ) -> Result<State<L::Scalar, N>, StepError> {
        beginning(self.system, &self.memory, [time, self.step_size().widen()], state, mean, elapsed)
    }
}

impl<L, M, const N: usize> Restartable<N> for Trajectory<'_, L, M, N>
where
    L: Flow<M, N>,
{
    fn restart_at(&mut self, time: f64, state: State<L::Scalar, N>) {
        self.restart_at(time, state);
    }
}

/// A step of size `elapsed` from `state` at `time`, from which the last one, of size `h`, was taken.
pub(in crate::run) fn beginning<L: Flow<M, N>, M, const N: usize>(
    system: &L,
    memory: &L::RunMemory,
    [time, h]: [f64; 2],
    state: &State<L::Scalar, N>,
    mean: &SVector<L::Scalar, N>,
    elapsed: L::Scalar,
) -> Result<State<L::Scalar, N>, StepError> {
    let of = L::Scalar::constant;
    system.later(of(time), |system| match memory.beginning(system, state, of(h), elapsed) {
        Some(state) => Ok(state),
        None => system.step(state, elapsed, Some(mean)).map(|step| step.state),
    })
}
