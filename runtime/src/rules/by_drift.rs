//! The flow of the rules fitted to linear damping: what depends on h alone is worked out once a step, in a
//! run once for each step size.

use nalgebra::SVector;

use super::{ByDrift, DampedDrift, Fitted, FittedTrapezoidal};
use crate::step::{
    BoundedFlow, BoundedStep, ByFormula, ClosedForm, Flow, LinearizedStep, State, Step, StepError,
    step_matrix,
};
use crate::system::Rayleigh;

macro_rules! flow {
    ($($rule:ident)*) => {$(
        impl ByFormula for $rule {}

        impl<L, const N: usize> Flow<$rule, N> for L
        where
            L: ClosedForm<$rule, N> + Rayleigh<N> + ?Sized,
        {
            type RunMemory = L::Memory;

            #[inline]
            fn step(
                &self,
                state: &State<L::Scalar, N>,
                h: L::Scalar,
                guess: Option<&SVector<L::Scalar, N>>,
            ) -> Result<Step<L::Scalar, N>, StepError> {
                $rule::step_by(&DampedDrift::of(self, &state.q, h), self, state, h, guess)
            }

            fn linearized_step(
                &self,
                state: &State<L::Scalar, N>,
                h: L::Scalar,
                guess: Option<&SVector<L::Scalar, N>>,
            ) -> Result<LinearizedStep<L::Scalar, N>, StepError> {
                let step = Flow::<$rule, N>::step(self, state, h, guess)?;
                Ok((step, step_matrix::<L, $rule, N>(self, state, &step, h)?))
            }
        }

        impl<L, const N: usize> BoundedFlow<$rule, N> for L
        where
            L: ClosedForm<$rule, N> + Rayleigh<N> + ?Sized,
        {
            fn step_within(
                &self,
                state: &State<L::Scalar, N>,
                h: L::Scalar,
                guess: Option<&SVector<L::Scalar, N>>,
                iterations: u32,
            ) -> Result<BoundedStep<L::Scalar, N>, StepError> {
                $rule::step_within_by(self, state, h, guess, iterations)
            }
        }
    )*};
}

flow! { Fitted FittedTrapezoidal }
