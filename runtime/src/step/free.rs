//! Steps that nothing holds beside L, R and f.

use core::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use crate::numbers::Factored;
use crate::step::equation::OfRule;
use crate::step::{
    Border, BorderParameters, BoundedStep, ClosedForm, Discrete, Fused, LegendreDerivatives, Momenta,
    MomentaBy, PhaseMatrix, Segment, State, StateBy, Step, StepError, invert, step_by, step_within_by,
};
use crate::system::Lagrangian;

/// No border: a system without constraints, whose steps end by `E`.
#[derive(Clone, Copy, Debug)]
pub struct Free<E = OfFormula>(PhantomData<fn() -> E>);

/// The end of a step whose equation is solved for v̄.
pub trait Ending<L: Lagrangian<N> + ?Sized, R, const N: usize> {
    /// Whether the momenta of the equation are those of the step.
    const IS_OF_EQUATION: bool;

    /// p0, and what the equation has for p1.
    fn momenta(system: &L, segment: &Segment<L::Scalar, N>) -> Momenta<L::Scalar, N>;

    /// The step of size h from `state` that was solved for.
    ///
    /// # Errors
    /// Those of the end.
    fn ended(
        system: &L,
        state: &State<L::Scalar, N>,
        step: Step<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError>;
}

/// Ends of steps by a formula for p1: D2 L_d + f_d⁺.
#[derive(Clone, Copy, Debug)]
pub struct OfFormula;

impl<L, R, const N: usize> Ending<L, R, N> for OfFormula
where
    L: Fused<R, N> + ?Sized,
{
    const IS_OF_EQUATION: bool = true;

    #[inline]
    fn momenta(system: &L, segment: &Segment<L::Scalar, N>) -> Momenta<L::Scalar, N> {
        Fused::<R, N>::momenta(system, segment)
    }

    #[inline(always)]
    fn ended(
        _: &L,
        _: &State<L::Scalar, N>,
        step: Step<L::Scalar, N>,
        _: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        Ok(step)
    }
}

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
