//! Rules whose steps can be asked how their end follows what they depend on.

use crate::step::{Discrete, PhaseMatrix, State, Step, StepError};

/// A rule whose steps are asked how their end follows their start: rules, not what is composed of their
/// steps.
///
/// [`StepTaken`](crate::derivative::StepTaken) asks.
#[diagnostic::on_unimplemented(
    message = "a step by `{M}` is not linearised where it was taken",
    label = "rules alone are asked for derivatives here",
    note = "`system.by(method, h).linearized_step(&state)` gives A of compositions and splittings"
)]
pub trait Linearizable<M, const N: usize>: Discrete<M, N> {
    /// The equations at the step, linearised and factored.
    type Linearized<'a>
    where
        Self: 'a;

    /// The equations at `step`, which was taken from `state` with what `memory` now remembers. Where that was
    /// told to leave stages unsolved ([`Memory::leave_unsolved`](crate::step::Memory::leave_unsolved)), they
    /// are the equations at the stages as they were left, and so are the derivatives.
    ///
    /// # Errors
    /// [`StepError::SingularNewtonMatrix`] where the step has no derivative, [`StepError::NonFinite`].
    fn linearized<'a>(
        &'a self,
        memory: &Self::RunMemory,
        state: &State<Self::Scalar, N>,
        step: &Step<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Result<Self::Linearized<'a>, StepError>;

    /// The equations on a segment, whose points are solved for.
    ///
    /// # Errors
    /// Those of [`linearized`](Self::linearized).
    fn linearized_on<'a>(on: Self::On<'a>) -> Result<Self::Linearized<'a>, StepError>
    where
        Self: 'a;

    /// A = ∂(q1, p1)/∂(q0, p0).
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn by_state(at: &Self::Linearized<'_>) -> Result<PhaseMatrix<Self::Scalar, N>, StepError>;
}
