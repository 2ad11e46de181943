//! The derivatives of a step: how its end follows its start, the input and parameters, its equations
//! linearised and factored once.

use crate::step::{
    DiscreteDriven, DiscreteParameters, DiscreteSecondOrder, Linearizable, PhaseMatrix, State, StateBy, Step,
    StepError, StepHessian,
};

/// A step that was taken, and what it can be asked: how its end follows its start, the input and parameters.
///
/// The equations are linearised and factored once, whatever is asked.
/// [`Discretised::linearized`](crate::Discretised::linearized) takes such a step, a run with inputs by
/// [`advance_linearized`](crate::run::DrivenTrajectory::advance_linearized); the step between two ends is
/// [`DiscreteSegment::linearized`](crate::step::DiscreteSegment::linearized).
pub struct StepTaken<'a, L, M, const N: usize>
where
    L: Linearizable<M, N> + 'a,
{
    step: Step<L::Scalar, N>,
    linearized: L::Linearized<'a>,
}

impl<'a, L, M, const N: usize> StepTaken<'a, L, M, N>
where
    L: Linearizable<M, N> + 'a,
{
    pub(crate) fn new(
        system: &'a L,
        memory: &L::RunMemory,
        state: &State<L::Scalar, N>,
        step: Step<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Self, StepError> {
        Ok(Self { step, linearized: system.linearized(memory, state, &step, h)? })
    }

    pub(crate) fn on(on: L::On<'a>, step: Step<L::Scalar, N>) -> Result<Self, StepError> {
        Ok(Self { step, linearized: L::linearized_on(on)? })
    }

    /// The step.
    #[must_use]
    pub fn step(&self) -> &Step<L::Scalar, N> {
        &self.step
    }

    /// A = ∂(q1, p1)/∂(q0, p0), the input being held.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn by_state(&self) -> Result<PhaseMatrix<L::Scalar, N>, StepError> {
        L::by_state(&self.linearized)
    }

    /// B = ∂(q1, p1)/∂u, the input being held over the step: of a view, `system.driven(u)`.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn by_input<const U: usize>(&self) -> Result<StateBy<L::Scalar, N, U>, StepError>
    where
        L: DiscreteDriven<M, N, U>,
    {
        L::by_input(&self.linearized)
    }

    /// ∂(q1, p1)/∂θ by the parameters that the attribute lists.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn by_parameters<const P: usize>(&self) -> Result<StateBy<L::Scalar, N, P>, StepError>
    where
        L: DiscreteParameters<M, N, P>,
    {
        L::by_parameters(&self.linearized)
    }

    /// Second derivatives of `covector`.q·q1 + `covector`.p·p1 by (q0, p0, u), of a system with
    /// `step_derivatives = second`.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn hessian<const U: usize>(
        &self,
        covector: &State<L::Scalar, N>,
    ) -> Result<StepHessian<L::Scalar, N, U>, StepError>
    where
        L: DiscreteSecondOrder<M, N, U>,
    {
        L::hessian(&self.linearized, covector)
    }
}
