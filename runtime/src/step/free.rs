//! Steps that nothing holds beside L, R and f.

use core::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use crate::numbers::Factored;
use crate::step::equation::OfRule;
use crate::step::{
    Border, BorderParameters, BoundedStep, ClosedForm, Discrete, Ending, LegendreDerivatives, MomentaBy,
    OfFormula, PhaseMatrix, Segment, State, StateBy, Step, StepError, invert, step_by, step_within_by,
};

/// No border: a system without constraints, whose steps end by `E`.
#[derive(Clone, Copy, Debug)]
pub struct Free<E = OfFormula>(PhantomData<fn() -> E>);

impl<L, R, E, const N: usize> Border<L, R, N> for Free<E>
where
    L: ClosedForm<R, N> + Discrete<R, N> + ?Sized,
    E: Ending<L, R, N>,
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
        let step = step_by(system, &OfRule::<L, R, E>::new(system), state, h, guess);
        if E::IS_OF_EQUATION { step } else { E::ended(system, state, step?, h) }
    }

    #[inline]
    fn step_within(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError> {
        let equation = OfRule::<L, R, E>::new(system);
        let BoundedStep { step, converged } = step_within_by(system, &equation, state, h, guess, iterations)?;
        Ok(BoundedStep { step: E::ended(system, state, step, h)?, converged })
    }

    #[inline]
    fn underway(_: &L, _: &Segment<L::Scalar, N>, _: &impl Factored<L::Scalar, N>) -> Option<()> {
        E::IS_OF_EQUATION.then_some(())
    }

    #[inline]
    fn completed(system: &L, step: Step<L::Scalar, N>, h: L::Scalar) -> Option<Step<L::Scalar, N>> {
        let _ = (system, h);
        E::IS_OF_EQUATION.then_some(step)
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

impl<L, R, E, const N: usize, const P: usize> BorderParameters<L, R, N, P> for Free<E>
where
    L: ClosedForm<R, N> + Discrete<R, N> + ?Sized,
    E: Ending<L, R, N>,
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
