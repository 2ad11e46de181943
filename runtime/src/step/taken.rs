//! The derivatives of a step: how its end follows its start, the input and parameters, its equations
//! linearised and factored once.

use nalgebra::SMatrix;

use crate::step::discrete::explained_on;
use crate::step::{
    ByFormula, ClosedForm, Discrete, DiscreteDriven, DiscreteObjects, DiscreteParameters,
    DiscreteSecondOrder, Flow, Formulas, LegendreDerivatives, MomentaBy, PhaseMatrix, Segment, State,
    StateBy, Step, StepError, StepHessian, invert,
};

/// A rule whose steps are asked how their end follows their start: rules, not what is composed of their
/// steps.
///
/// [`StepTaken`] asks.
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

/// The derivatives of both Legendre transforms on the segment of a step, and what dp0 makes of q1.
pub struct LinearizedSegment<'a, L: ClosedForm<R, N>, R, const N: usize> {
    pub(crate) on: Formulas<'a, L, R, N>,
    pub(crate) k: LegendreDerivatives<L::Scalar, N>,
    /// K01⁻¹.
    pub(crate) q_by_p: SMatrix<L::Scalar, N, N>,
}

impl<L: ClosedForm<R, N> + Discrete<R, N>, R, const N: usize> LinearizedSegment<'_, L, R, N> {
    /// The derivatives of (q1, p1) by what moves the momenta so at fixed ends.
    pub(crate) fn answer<const M: usize>(
        &self,
        momenta: &MomentaBy<L::Scalar, N, M>,
    ) -> Result<StateBy<L::Scalar, N, M>, StepError> {
        self.k.answer(&self.q_by_p, momenta).map_err(|error| self.explained(error))
    }

    fn explained(&self, error: StepError) -> StepError {
        explained_on::<L, R, N>(self.on.system, self.on.segment(), error)
    }
}

impl<L, R, const N: usize> Linearizable<R, N> for L
where
    R: ByFormula,
    L: ClosedForm<R, N> + Flow<R, N>,
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
        Self::linearized_on(self.on(&Segment { q0: state.q, v: step.velocity, h })?)
    }

    fn linearized_on<'a>(on: Formulas<'a, L, R, N>) -> Result<LinearizedSegment<'a, L, R, N>, StepError>
    where
        L: 'a,
    {
        let k = on.legendre_derivatives()?;
        let q_by_p =
            invert(&k.p0_by_q1).map_err(|error| explained_on::<L, R, N>(on.system, on.segment(), error))?;
        Ok(LinearizedSegment { on, k, q_by_p })
    }

    fn by_state(at: &LinearizedSegment<'_, L, R, N>) -> Result<PhaseMatrix<L::Scalar, N>, StepError> {
        at.k.step_matrix_with(&at.q_by_p).map_err(|error| at.explained(error))
    }
}

/// A of a step by a rule that has formulas.
pub(crate) fn step_matrix<L, R, const N: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    step: &Step<L::Scalar, N>,
    h: L::Scalar,
) -> Result<PhaseMatrix<L::Scalar, N>, StepError>
where
    L: ClosedForm<R, N> + Discrete<R, N> + ?Sized,
{
    let segment = Segment { q0: state.q, v: step.velocity, h };
    system
        .on(&segment)?
        .legendre_derivatives()
        .and_then(|k| k.step_matrix())
        .map_err(|error| explained_on::<L, R, N>(system, &segment, error))
}

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
