//! Steps on constraints.
//!
//! ```text
//! p0 = −D1 L_d − f_d⁻ − (h/2) G(q0)ᵀλ        g(q1) = 0
//! p1 = D2 L_d + f_d⁺ + G(q1)ᵀμ               μ: G(q1)·v(q1, p1) = 0
//! ```
//!
//! with L_d and f_d of the rule, and G = ∂g/∂q. The pair (L_d, R_d), restricted to N×N with N = g⁻¹(0), is a
//! Rayleigh pair again, whose step this is: the motion depends on N alone, neither on how g is written nor on
//! μ.
//!
//! **The equation for v̄ alone.** λ enters linearly. With W = ∂p0/∂v̄, r = p0(v̄) − p0 and c = g(q1)/h a
//! Newton step is
//!
//! ```text
//! ⎡ W        G(q0)ᵀ ⎤ ⎡ δ ⎤   ⎡ r ⎤
//! ⎣ G(q1)      0    ⎦ ⎣ κ ⎦ = ⎣ c ⎦        κ = (h/2)λ,   v̄ ← v̄ − δ
//! ```
//!
//! so that W δ = F(v̄) = r − G(q0)ᵀ S⁻¹(G(q1) W⁻¹ r − c), S = G(q1) W⁻¹ G(q0)ᵀ. The solver of every other
//! step is given F, whose root is the step on N, with the matrix W: band, guesses, damping and verdicts stay
//! as they are, and no second derivative of g is asked for.

mod bordered;
pub(super) mod complement;
mod dependence;
mod equation;
pub(super) mod independent;
mod inertia;
mod instant;
mod linearized;
mod nearest;
mod reactions;
mod rows;
mod undefined;

use nalgebra::{SMatrix, SVector};

use crate::numbers::Factored;
use crate::step::{
    Border, BoundedStep, ClosedForm, Discrete, LegendreDerivatives, Momenta, MomentaBy, PhaseMatrix, Segment,
    State, StateBy, Step, StepError, step_at_length_by, step_by, step_within_by,
};
use crate::system::Constrained;
pub use bordered::Bordered;
use bordered::rounding_of_reactions;
use equation::OnConstraints;
pub(crate) use instant::reactions_at;
pub use linearized::Linearized;
use nearest::{held, require_on};

/// The border of a system with M constraints, [`Constrained`]: steps stay on N = g⁻¹(0), and satisfy those of
/// velocity.
#[derive(Clone, Copy, Debug)]
pub struct Constraints<const M: usize>;

impl<L, R, const N: usize, const M: usize> Border<L, R, N> for Constraints<M>
where
    L: ClosedForm<R, N> + Discrete<R, N> + Constrained<N, M>,
{
    type Linearized = Linearized<L::Scalar, N, M>;
    type Underway = Bordered<L::Scalar, N, M>;

    fn step(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let equation = OnConstraints::<L, R, N, M>::new(system, state)?;
        let step = step_by(system, &equation, state, h, guess)
            .map_err(|error| equation.explained(error, h, guess.is_some()))?;
        match equation.on_constraints(step, h) {
            // A guess that has led off N is left by the caller.
            Err(StepError::NoRealSolution { .. }) if guess.is_none() => {
                step_at_length_by(system, &equation, state, h)
                    .and_then(|step| equation.on_constraints(step, h))
                    .map_err(|error| equation.explained(error, h, false))
            }
            other => other,
        }
    }

    fn step_within(
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
        iterations: u32,
    ) -> Result<BoundedStep<L::Scalar, N>, StepError> {
        let equation = OnConstraints::<L, R, N, M>::new(system, state)?;
        let BoundedStep { step, converged } = step_within_by(system, &equation, state, h, guess, iterations)
            .map_err(|error| equation.dependence(error).unwrap_or(error))?;
        Ok(BoundedStep { step: equation.on_constraints(step, h)?, converged })
    }

    fn underway(
        system: &L,
        guess: &Segment<L::Scalar, N>,
        factored: &impl Factored<L::Scalar, N>,
    ) -> Option<Self::Underway> {
        let (values, gradients) = system.constraint_gradients(&guess.q0);
        require_on(system, (&values, &gradients), &guess.q0).ok()?;
        Bordered::of(system, guess, gradients.transpose(), factored)
    }

    #[inline]
    fn residual(
        underway: &Self::Underway,
        system: &L,
        segment: &Segment<L::Scalar, N>,
        factored: &impl Factored<L::Scalar, N>,
        p: &SVector<L::Scalar, N>,
        momenta: &mut Momenta<L::Scalar, N>,
    ) -> SVector<L::Scalar, N> {
        let residual = underway.residual_near(system, segment, factored, momenta.p0 - p);
        momenta.p0 = p + residual;
        residual
    }

    fn floor(
        floor: SVector<L::Scalar, N>,
        without: &SVector<L::Scalar, N>,
        with: &SVector<L::Scalar, N>,
    ) -> SVector<L::Scalar, N> {
        floor + rounding_of_reactions(without, with)
    }

    fn is_off(underway: &Self::Underway, system: &L, segment: &Segment<L::Scalar, N>) -> bool {
        underway.is_off(system, segment)
    }

    fn completed(system: &L, step: Step<L::Scalar, N>, h: L::Scalar) -> Option<Step<L::Scalar, N>> {
        held::<L, N, M>(system, step, h).ok()
    }

    fn nearest(system: &L, state: &State<L::Scalar, N>) -> Option<State<L::Scalar, N>> {
        let v = state.velocity(system).ok()?;
        State::nearest(system, state.q, v).ok()
    }

    fn linearized(
        system: &L,
        segment: &Segment<L::Scalar, N>,
        _: Option<&SVector<L::Scalar, N>>,
        k: &LegendreDerivatives<L::Scalar, N>,
    ) -> Result<(SMatrix<L::Scalar, N, N>, Self::Linearized), StepError> {
        Linearized::of::<L, R>(system, segment, k)
    }

    fn by_state(
        k: &LegendreDerivatives<L::Scalar, N>,
        q_by_p: &SMatrix<L::Scalar, N, N>,
        at: &Self::Linearized,
    ) -> Result<PhaseMatrix<L::Scalar, N>, StepError> {
        at.by_state(k, q_by_p)
    }

    fn answer<const P: usize>(
        k: &LegendreDerivatives<L::Scalar, N>,
        q_by_p: &SMatrix<L::Scalar, N, N>,
        at: &Self::Linearized,
        momenta: &MomentaBy<L::Scalar, N, P>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError> {
        at.answer(k, q_by_p, momenta)
    }
}
