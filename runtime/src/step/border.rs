//! The border of a step's equation: what holds the motion beside L, R and f.

use nalgebra::SVector;

use crate::step::equation::OfRule;
use crate::step::{
    BoundedStep, ClosedForm, Discrete, PhaseMatrix, State, Step, StepError, step_by, step_matrix,
    step_within_by,
};
use crate::system::Lagrangian;

/// The border of the equation of a step by rule `R`: what holds the motion beside L, R and f, and how the step
/// is solved with it. It alone knows how many multipliers there are.
///
/// A system names it: [`Free`], or [`Holonomic`](crate::step::Holonomic) constraints.
pub trait Border<L: Lagrangian<N> + ?Sized, R, const N: usize> {
    /// [`Flow::step`](crate::step::Flow::step).
    ///
    /// # Errors
    /// Those of [`Flow::step`](crate::step::Flow::step).
    fn step(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<Step<L::Scalar, N>, StepError>;

    /// [`BoundedFlow::step_within`](crate::step::BoundedFlow::step_within).
    ///
    /// # Errors
    /// Those of [`BoundedFlow::step_within`](crate::step::BoundedFlow::step_within).
    fn step_within(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError>;

    /// A = ∂(q1, p1)/∂(q0, p0) of the `step` from `state`.
    ///
    /// # Errors
    /// [`StepError::SingularNewtonMatrix`] where it has none, [`StepError::NonFinite`].
    fn step_matrix(
        system: &L,
        state: &State<L::Scalar, N>,
        step: &Step<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<PhaseMatrix<L::Scalar, N>, StepError>;
}

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
