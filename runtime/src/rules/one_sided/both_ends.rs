//! The step with its end: solved for v̄ without it, then for v1 once.

use nalgebra::{SMatrix, SVector};

use super::end::End;
use super::{OneSided, without_end};
use crate::numbers::Factored;
use crate::step::equation::{Equation, OfRule, StepEquation};
use crate::step::{
    Border, BoundedStep, ClosedForm, Discrete, Free, Fused, LegendreDerivatives, Momenta, MomentaBy,
    PhaseMatrix, Segment, State, StateBy, Step, StepError, StepKernel, step_by, step_within_by,
};
use crate::system::{ActingForce, Rayleigh};

/// The border of steps by [`OneSided`]: the end of a step is an equation for v1 by itself, which may fail.
#[derive(Clone, Copy, Debug)]
pub struct BothEnds;

/// The equation of a step for v̄, which asks no end of a segment on the way.
struct Start<'a, L> {
    system: &'a L,
    by_rule: OfRule<'a, L, OneSided>,
}

impl<'a, L> Start<'a, L> {
    fn of(system: &'a L) -> Self {
        Self { system, by_rule: OfRule::new(system) }
    }
}

impl<L, const N: usize> StepEquation<L::Scalar, N> for Start<'_, L>
where
    L: ClosedForm<OneSided, N> + Discrete<OneSided, N> + Rayleigh<N> + ActingForce<N>,
{
    type Matrix = <L as Fused<OneSided, N>>::Matrix;

    fn kernel(&self, segment: &Segment<L::Scalar, N>) -> StepKernel<L::Scalar, N, Self::Matrix> {
        self.by_rule.kernel(segment)
    }

    /// p0, and w in place of p1.
    fn momenta(&self, segment: &Segment<L::Scalar, N>) -> Momenta<L::Scalar, N> {
        without_end(self.system, segment)
    }

    fn inertia(&self, segment: &Segment<L::Scalar, N>) -> SMatrix<L::Scalar, N, N> {
        self.by_rule.inertia(segment)
    }

    fn cancelling(&self, segment: &Segment<L::Scalar, N>) -> SVector<L::Scalar, N> {
        self.by_rule.cancelling(segment)
    }

    fn kind(&self) -> Equation {
        self.by_rule.kind()
    }

    fn takes_massless(&self) -> bool {
        self.by_rule.takes_massless()
    }

    fn cause(&self, segment: &Segment<L::Scalar, N>) -> Option<StepError> {
        self.by_rule.cause(segment)
    }
}

/// The step that was solved for up to w.
fn ended<L: Rayleigh<N>, const N: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    step: Step<L::Scalar, N>,
    h: L::Scalar,
) -> Result<Step<L::Scalar, N>, StepError> {
    let segment = Segment { q0: state.q, v: step.velocity, h };
    let end = End::of(system, &segment);
    let p = end.momentum(&end.velocity(&step.state.p)?);
    let state = State { q: step.state.q, p };
    state.require_reached()?;
    Ok(Step { state, ..step })
}

impl<L, const N: usize> Border<L, OneSided, N> for BothEnds
where
    L: ClosedForm<OneSided, N> + Discrete<OneSided, N> + Rayleigh<N> + ActingForce<N>,
{
    type Linearized = ();
    type Underway = ();

    fn step(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let step = step_by(system, &Start::of(system), state, h, guess)?;
        ended(system, state, step, h)
    }

    fn step_within(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError> {
        let BoundedStep { step, converged } =
            step_within_by(system, &Start::of(system), state, h, guess, iterations)?;
        Ok(BoundedStep { step: ended(system, state, step, h)?, converged })
    }

    /// The general way solves it.
    fn underway(_: &L, _: &Segment<L::Scalar, N>, _: &impl Factored<L::Scalar, N>) -> Option<()> {
        None
    }

    fn completed(_: &L, _: Step<L::Scalar, N>, _: L::Scalar) -> Option<Step<L::Scalar, N>> {
        None
    }

    fn linearized(
        system: &L,
        segment: &Segment<L::Scalar, N>,
        p0: Option<&SVector<L::Scalar, N>>,
        k: &LegendreDerivatives<L::Scalar, N>,
    ) -> Result<(SMatrix<L::Scalar, N, N>, ()), StepError> {
        <Free as Border<L, OneSided, N>>::linearized(system, segment, p0, k)
    }

    fn by_state(
        k: &LegendreDerivatives<L::Scalar, N>,
        q_by_p: &SMatrix<L::Scalar, N, N>,
        (): &(),
    ) -> Result<PhaseMatrix<L::Scalar, N>, StepError> {
        k.step_matrix_with(q_by_p)
    }

    fn answer<const P: usize>(
        k: &LegendreDerivatives<L::Scalar, N>,
        q_by_p: &SMatrix<L::Scalar, N, N>,
        (): &(),
        momenta: &MomentaBy<L::Scalar, N, P>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError> {
        k.answer(q_by_p, momenta)
    }
}
