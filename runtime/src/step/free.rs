//! Steps that nothing holds beside L, R and f.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Factored;
use crate::step::equation::OfRule;
use crate::step::{
    Border, BorderParameters, BoundedStep, ClosedForm, Discrete, LegendreDerivatives, MomentaBy, PhaseMatrix,
    Segment, State, StateBy, Step, StepError, invert, step_by, step_within_by,
};

/// No border: a system without constraints.
#[derive(Clone, Copy, Debug)]
pub struct Free;

impl<L, R, const N: usize> Border<L, R, N> for Free
where
    L: ClosedForm<R, N> + Discrete<R, N> + ?Sized,
{
    type Linearized = ();
    type Underway = ();

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

    #[inline]
    fn underway(_: &L, _: &Segment<L::Scalar, N>, _: &impl Factored<L::Scalar, N>) -> Option<()> {
        Some(())
    }

    #[inline]
    fn completed(_: &L, step: Step<L::Scalar, N>, _: L::Scalar) -> Option<Step<L::Scalar, N>> {
        Some(step)
    }

    fn linearized(
        _: &L,
        _: &Segment<L::Scalar, N>,
        _: Option<&SVector<L::Scalar, N>>,
        k: &LegendreDerivatives<L::Scalar, N>,
    ) -> Result<(SMatrix<L::Scalar, N, N>, ()), StepError> {
        Ok((invert(&k.p0_by_q1)?, ()))
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

impl<L, R, const N: usize, const P: usize> BorderParameters<L, R, N, P> for Free
where
    L: ClosedForm<R, N> + Discrete<R, N> + ?Sized,
{
    fn answer_parameters(
        _: &L,
        _: &Segment<L::Scalar, N>,
        k: &LegendreDerivatives<L::Scalar, N>,
        q_by_p: &SMatrix<L::Scalar, N, N>,
        (): &(),
        momenta: &MomentaBy<L::Scalar, N, P>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError> {
        k.answer(q_by_p, momenta)
    }
}
