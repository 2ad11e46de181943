//! Steps that nothing holds beside L, R and f.

use nalgebra::SVector;

use crate::step::equation::OfRule;
use crate::step::{
    Border, BoundedStep, ClosedForm, Discrete, PhaseMatrix, State, Step, StepError, step_by, step_matrix,
    step_within_by,
};

/// No border: a system without constraints.
#[derive(Clone, Copy, Debug)]
pub struct Free;

impl<L, R, const N: usize> Border<L, R, N> for Free
where
    L: ClosedForm<R, N> + Discrete<R, N> + ?Sized,
{
    #[inline]
    fn step(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        step_by(system, &OfRule::<L, R>::new(system), state, h, guess)
    }

    #[inline]
    fn step_within(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError> {
        step_within_by(system, &OfRule::<L, R>::new(system), state, h, guess, iterations)
    }

    fn step_matrix(
        system: &L,
        state: &State<L::Scalar, N>,
        step: &Step<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<PhaseMatrix<L::Scalar, N>, StepError> {
        step_matrix(system, state, step, h)
    }
}
