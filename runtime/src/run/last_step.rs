//! The last step of a run, by what its method remembers of it.

use core::marker::PhantomData;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::{Flow, Memory, State, StepError};
use crate::system::Lagrangian;

/// A function called with the index of a node, with q there and with v.
type Visit<'v, S, const N: usize> = dyn FnMut(usize, &SVector<S, N>, &SVector<S, N>) + 'v;

/// The last step of a method as it can be looked into: what [`Memory`] has, of a method that need not be
/// known when the program is compiled.
pub trait LastStep<L: Lagrangian<N>, const N: usize> {
    /// Shares of the step at which the method itself knows q and v ([`Memory::NODES`]).
    fn nodes(&self) -> &'static [f64];

    /// Calls `visit` with q and v there; the step led from `q0` by `h`.
    fn at_nodes(&self, q0: &SVector<L::Scalar, N>, h: L::Scalar, visit: &mut Visit<'_, L::Scalar, N>);

    /// (q, v) at a share of the step, by the method's own polynomial.
    fn between(
        &self,
        q0: &SVector<L::Scalar, N>,
        h: L::Scalar,
        share: f64,
    ) -> Option<[SVector<L::Scalar, N>; 2]>;

    /// The velocity of a state of the run, `elapsed` after the time of `system`: by what is remembered of it,
    /// or else solved for.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    fn velocity(
        &self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
    ) -> Result<SVector<L::Scalar, N>, StepError>;

    /// Where a step leads from `state`, from which the last one was taken, `elapsed` after the time of
    /// `system`; `mean` is the mean velocity of that, `sizes` its size and that of this one.
    ///
    /// # Errors
    /// Those of the step.
    fn beginning(
        &self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
        mean: &SVector<L::Scalar, N>,
        sizes: [L::Scalar; 2],
    ) -> Result<State<L::Scalar, N>, StepError>;
}

/// A memory with the method that it is of.
pub struct Remembered<M, K>(pub(in crate::run) K, PhantomData<fn() -> M>);

impl<M, K> Remembered<M, K> {
    pub(in crate::run) fn new(memory: K) -> Self {
        Self(memory, PhantomData)
    }
}

impl<M, K: Default> Default for Remembered<M, K> {
    fn default() -> Self {
        Self::new(K::default())
    }
}

impl<M, K: Clone> Clone for Remembered<M, K> {
    fn clone(&self) -> Self {
        Self::new(self.0.clone())
    }
}

impl<L, M, K, const N: usize> LastStep<L, N> for Remembered<M, K>
where
    L: Flow<M, N, RunMemory = K>,
    K: Memory<L, M, N>,
{
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn nodes(&self) -> &'static [f64] {
        K::NODES
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn at_nodes(&self, q0: &SVector<L::Scalar, N>, h: L::Scalar, visit: &mut Visit<'_, L::Scalar, N>) {
        self.0.at_nodes(q0, h, visit);
    }

    fn between(
        &self,
        q0: &SVector<L::Scalar, N>,
        h: L::Scalar,
        share: f64,
    ) -> Option<[SVector<L::Scalar, N>; 2]> {
        self.0.between(q0, h, share)
    }

    #[inline]
    fn velocity(
        &self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
    ) -> Result<SVector<L::Scalar, N>, StepError> {
        match self.0.velocity(state) {
            Some(velocity) => Ok(velocity),
            None => system.later(L::Scalar::constant(elapsed), |system| state.velocity(system)),
        }
    }

    fn beginning(
        &self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
        mean: &SVector<L::Scalar, N>,
        [h, size]: [L::Scalar; 2],
    ) -> Result<State<L::Scalar, N>, StepError> {
        system.later(L::Scalar::constant(elapsed), |system| match self.0.beginning(system, state, h, size) {
            Some(state) => Ok(state),
            None => system.step(state, size, Some(mean)).map(|step| step.state),
        })
    }
}
