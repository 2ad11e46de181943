//! Steps with friction that holds: the kinks of R at both ends.
//!
//! ```text
//! p0 ∈ −D1(L_d + R_d) − f_d⁻ + (h/2) ∂R_k(q̄, v̄)         R = R_s + R_k, and R_d that of R_s
//! w  = D2(L_d − R_d) + f_d⁺
//! w  ∈ ∂L/∂v(q1, v1) + (h/2) ∂R_k(q̄, v1)                p1 = ∂L/∂v(q1, v1)
//! ```
//!
//! **The equation for v̄ alone.** With W = ∂p0/∂v̄ of the smooth part, r = p0(v̄) − p0 and D = (h/2) Fₖ
//! ∂uₖ/∂v column by column, a Newton step solves for v̄ and the forces s at once:
//!
//! ```text
//! W δ = r + D s = F(v̄),   u(v̄) − ∂u/∂v̄ δ = λ s,   |sₖ| ≤ 1,   λₖ = 0 where |sₖ| < 1
//! ```
//!
//! Elements that stick are a border of W, as constraints of velocity are; which of them do, [`set`] finds.
//! The solver of every other step is given F, whose root is the step, with the matrix W.

mod balanced;
mod element;
mod end;
mod equation;
mod line;
mod linearized;
mod linearized_balance;
mod rates;
mod root;
mod set;
mod sliding;
mod slipping;
mod state;
mod sticking;
mod unturned;

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Factored, Scalar};
use crate::step::{
    Border, BorderParameters, BoundedStep, ClosedForm, Discrete, LegendreDerivatives, MomentaBy, PhaseMatrix,
    Segment, State, StateBy, Step, StepError, step_by, step_within_by,
};
use crate::system::{DryFriction, DryFrictionParameters, Parameters};
use balanced::at_end;
use end::{End, Middle, velocity};
use equation::WithFriction;
use linearized::LinearizedFriction;
pub use rates::massless_velocity;
pub(crate) use slipping::{Slip, Slipping};
use sticking::sticking;

/// Kinks of R with M components in all, [`DryFriction`]: the border of a step with friction that holds.
#[derive(Clone, Copy, Debug)]
pub struct Friction<const M: usize>;

/// The step by the sets of what sticks and what slides.
#[inline(never)]
fn by_sets<L, R, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    h: L::Scalar,
    guess: Option<&SVector<L::Scalar, N>>,
) -> Result<Step<L::Scalar, N>, StepError>
where
    L: ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M>,
{
    let equation = WithFriction::<L, R, N, M>::new(system, state);
    let step = step_by(system, &equation, state, h, guess).map_err(|error| equation.explained(error))?;
    held::<L, R, N, M>(system, state, step, h, &equation)
}

/// The step that was solved for up to its end.
#[inline(always)]
fn held<L, R, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    step: Step<L::Scalar, N>,
    h: L::Scalar,
    equation: &WithFriction<'_, L, R, N, M>,
) -> Result<Step<L::Scalar, N>, StepError>
where
    L: ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M>,
{
    if !L::IS_PROPORTIONAL {
        equation.require_convex(&Segment { q0: state.q, v: step.velocity, h })?;
    }
    let (mut v, mut w) = (step.velocity, step.state.p);
    if let Some(held) = equation.held(&Segment { q0: state.q, v, h })
        && held.sticks.contains(&true)
    {
        let half = h * L::Scalar::constant(0.5);
        let middle = state.q + v * half;
        // The slips are linear in v: at rest they are those of what moves by itself, a belt.
        let slips = system.later(half, |system| system.slips(&middle, &nalgebra::zero()));
        v = sticking(&slips, &v, &held);
        w = system.momenta(&Segment { q0: state.q, v, h }).p1;
    }
    let segment = Segment { q0: state.q, v, h };
    let end = end(system, &segment, &w)?;
    let q = if end.light.are_any() { at_end(system, &segment, &end)?.q } else { state.q + v * h };
    // By p0 + (p1 − p0) a small p1 would be rounded as p0 is, and what sticks would slip.
    let next = State { q, p: end.p };
    next.require_reached()?;
    Ok(Step { state: next, velocity: v, report: step.report })
}

/// The velocity at the end of a segment that is solved for, where p1 would be `w` without friction.
fn end<L, const N: usize, const M: usize>(
    system: &L,
    segment: &Segment<L::Scalar, N>,
    w: &SVector<L::Scalar, N>,
) -> Result<End<L::Scalar, N, M>, StepError>
where
    L: DryFriction<N, M>,
{
    let Segment { q0, v, h } = segment;
    let half = *h * L::Scalar::constant(0.5);
    let (q, q1) = (q0 + v * half, q0 + v * *h);
    system.later(half, |system| {
        let middle = Middle { system, h: *h, q, v: *v };
        system.later(half, |at_end| velocity(at_end, &q1, &middle, w))
    })
}

impl<L, R, const N: usize, const M: usize> Border<L, R, N> for Friction<M>
where
    L: ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M>,
{
    type Linearized = LinearizedFriction<L::Scalar, N, M>;
    type Underway = ();

    #[inline]
    fn step(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        match guess.and_then(|guess| unturned::step::<L, R, N, M>(system, state, h, guess)) {
            Some(step) => Ok(step),
            None => by_sets::<L, R, N, M>(system, state, h, guess),
        }
    }

    fn step_within(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError> {
        let equation = WithFriction::<L, R, N, M>::new(system, state);
        let BoundedStep { step, converged } = step_within_by(system, &equation, state, h, guess, iterations)
            .map_err(|error| equation.explained(error))?;
        let step = held::<L, R, N, M>(system, state, step, h, &equation)?;
        Ok(BoundedStep { step, converged })
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
    ) -> Result<(SMatrix<L::Scalar, N, N>, Self::Linearized), StepError> {
        LinearizedFriction::of::<L, R>(system, segment, p0, k)
    }

    fn by_state(
        k: &LegendreDerivatives<L::Scalar, N>,
        _: &SMatrix<L::Scalar, N, N>,
        at: &Self::Linearized,
    ) -> Result<PhaseMatrix<L::Scalar, N>, StepError> {
        at.by_state(k)
    }

    fn answer<const P: usize>(
        k: &LegendreDerivatives<L::Scalar, N>,
        _: &SMatrix<L::Scalar, N, N>,
        at: &Self::Linearized,
        momenta: &MomentaBy<L::Scalar, N, P>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError> {
        at.answer(k, momenta, |_, _| nalgebra::zero())
    }

    fn answer_input<const P: usize>(
        k: &LegendreDerivatives<L::Scalar, N>,
        _: &SMatrix<L::Scalar, N, N>,
        at: &Self::Linearized,
        momenta: &MomentaBy<L::Scalar, N, P>,
        at_end: impl Fn(&SVector<L::Scalar, N>, &SVector<L::Scalar, N>) -> SMatrix<L::Scalar, N, P>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError> {
        at.answer(k, momenta, at_end)
    }
}

impl<L, R, const N: usize, const M: usize, const P: usize> BorderParameters<L, R, N, P> for Friction<M>
where
    L: ClosedForm<R, N> + Discrete<R, N> + DryFrictionParameters<N, M, P> + Parameters<N, P>,
{
    fn answer_parameters(
        system: &L,
        segment: &Segment<L::Scalar, N>,
        k: &LegendreDerivatives<L::Scalar, N>,
        _: &SMatrix<L::Scalar, N, N>,
        at: &Self::Linearized,
        momenta: &MomentaBy<L::Scalar, N, P>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError> {
        at.answer_parameters(system, segment, k, momenta)
    }
}
