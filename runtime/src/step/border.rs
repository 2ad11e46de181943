//! The border of a step's equation: what holds the motion beside L, R and f.

use nalgebra::SVector;

use crate::step::{BoundedStep, PhaseMatrix, State, Step, StepError};
use crate::system::Lagrangian;

/// The border of the equation of a step by rule `R`: what holds the motion beside L, R and f, and how the
/// step is solved with it. It alone knows how many multipliers there are.
///
/// A system names it: [`Free`](crate::step::Free), or [`Holonomic`](crate::step::Holonomic) constraints.
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
