//! How a step that was taken follows what it depends on, its equations linearised and factored once.

use core::marker::PhantomData;

use nalgebra::SMatrix;

use crate::step::discrete::explained_on;
use crate::step::{
    Discrete, DiscreteDriven, DiscreteParameters, Flow, LegendreDerivatives, PhaseMatrix, SolvedForVelocity,
    State, StateBy, Step, StepError, invert,
};

/// A method whose step, once taken, can be asked how it follows its start, its input and parameters: rules,
/// not what is composed of their steps.
///
/// [`StepTaken`] asks.
#[diagnostic::on_unimplemented(
    message = "a step by `{M}` is not linearised where it was taken",
    label = "rules alone are asked for derivatives here",
    note = "`system.by(method, h).linearized_step(&state)` gives A of compositions and splittings"
)]
pub trait Linearizable<M, const N: usize>: Flow<M, N> {
    /// The equations at the step.
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

    /// A = ∂(q1, p1)/∂(q0, p0).
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn by_state(at: &Self::Linearized<'_>) -> Result<PhaseMatrix<Self::Scalar, N>, StepError>;

    /// B = ∂(q1, p1)/∂u.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn by_input<const U: usize>(at: &Self::Linearized<'_>) -> Result<StateBy<Self::Scalar, N, U>, StepError>
    where
        Self: DiscreteDriven<M, N, U>;

    /// ∂(q1, p1)/∂θ.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn by_parameters<const P: usize>(
        at: &Self::Linearized<'_>,
    ) -> Result<StateBy<Self::Scalar, N, P>, StepError>
    where
        Self: DiscreteParameters<M, N, P>;
}

/// The derivatives of both Legendre transforms on the segment of a step, and what dp0 makes of q1.
pub struct LinearizedSegment<'a, L: Flow<R, N>, R, const N: usize> {
    system: &'a L,
    rule: PhantomData<fn() -> R>,
    start: State<L::Scalar, N>,
    step: Step<L::Scalar, N>,
    h: L::Scalar,
    k: LegendreDerivatives<L::Scalar, N>,
    /// K01⁻¹.
    q_by_p: SMatrix<L::Scalar, N, N>,
}

impl<L: Discrete<R, N>, R, const N: usize> LinearizedSegment<'_, L, R, N> {
    fn explained(&self, error: StepError) -> StepError {
        explained_on(self.system, &self.start.q, &self.step.velocity, self.h, error)
    }
}

impl<L, R, const N: usize> Linearizable<R, N> for L
where
    R: SolvedForVelocity,
    L: Discrete<R, N>,
{
    type Linearized<'a>
        = LinearizedSegment<'a, L, R, N>
    where
        L: 'a;

    fn linearized<'a>(
        &'a self,
        _: &Self::RunMemory,
        state: &State<L::Scalar, N>,
        step: &Step<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<LinearizedSegment<'a, L, R, N>, StepError> {
        let k = self.legendre_derivatives(&state.q, &step.state.q, h);
        let q_by_p =
            invert(&k.p0_by_q1).map_err(|error| explained_on(self, &state.q, &step.velocity, h, error))?;
        Ok(LinearizedSegment { system: self, rule: PhantomData, start: *state, step: *step, h, k, q_by_p })
    }

    fn by_state(at: &LinearizedSegment<'_, L, R, N>) -> Result<PhaseMatrix<L::Scalar, N>, StepError> {
        at.k.step_matrix(&at.q_by_p).map_err(|error| at.explained(error))
    }

    fn by_input<const U: usize>(
        at: &LinearizedSegment<'_, L, R, N>,
    ) -> Result<StateBy<L::Scalar, N, U>, StepError>
    where
        L: DiscreteDriven<R, N, U>,
    {
        let by_input = at.system.momenta_by_input(&at.start.q, &at.step.velocity, at.h);
        at.k.answer_with(&at.q_by_p, &by_input).map_err(|error| at.explained(error))
    }

    fn by_parameters<const P: usize>(
        at: &LinearizedSegment<'_, L, R, N>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError>
    where
        L: DiscreteParameters<R, N, P>,
    {
        let by_parameters = at.system.momenta_by_parameters(&at.start.q, &at.step.velocity, at.h);
        at.k.answer_with(&at.q_by_p, &by_parameters).map_err(|error| at.explained(error))
    }
}

/// A step that was taken, and what it can be asked: how its end follows its start, the input and parameters.
///
/// The equations are linearised and factored once, whatever is asked. A run with inputs makes it:
/// [`DrivenTrajectory::advance_linearized`](crate::run::DrivenTrajectory::advance_linearized).
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

    /// B = ∂(q1, p1)/∂u, the input being held over the step.
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
}
