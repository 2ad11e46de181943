//! Runs whose steps can be looked into.

use super::LastStep;
use crate::run::{Run, TakenUntil, Trajectory};
use crate::step::{Flow, State};
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

    /// The last step, as the method remembers it.
    fn last_step(&self) -> &dyn LastStep<Self::System, N>;

    /// Shares of a step at which the method itself knows q and v
    /// ([`Memory::NODES`](crate::step::Memory::NODES)).
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn nodes(&self) -> &'static [f64] {
        self.last_step().nodes()
    }
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
    fn last_step(&self) -> &dyn LastStep<L, N> {
        &self.run.memory
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
