//! The derivative of a step on constraints.
//!
//! On N a step is (q0, p0) ↦ (q1, p1); it is extended to all of T*Q by the nearest state on N
//! ([`State::nearest`]), so that A is 2N×2N. With κ = (h/2)λ and the derivatives K of the momenta that the
//! rule has on a segment,
//!
//! ```text
//! dp0 = (K00 − κ·∂²g(q0)) dq0 + K01 dq1 − G(q0)ᵀdκ        G(q1) dq1 = 0
//! dp1 = K10 dq0 + K11 dq1 + μ·∂²g(q1) dq1 + G(q1)ᵀdμ      d(G(q1)·v(q1, p1)) = 0
//! ```

use nalgebra::{SMatrix, SVector};

use super::columns::by_columns;
use super::complement::Complement;
use super::equation::OnConstraints;
use super::inertia::Inertia;
use super::nearest::AtPoint;
use crate::step::{
    ClosedForm, Discrete, DiscreteObjects, LegendreDerivatives, PhaseMatrix, Segment, State, Step, StepError,
    invert,
};
use crate::system::Constrained;

/// A = ∂(q1, p1)/∂(q0, p0) of the `step` from `state`.
pub(super) fn step_matrix<L, R, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    step: &Step<L::Scalar, N>,
    h: L::Scalar,
) -> Result<PhaseMatrix<L::Scalar, N>, StepError>
where
    L: ClosedForm<R, N> + Discrete<R, N> + Constrained<N, M>,
{
    let segment = Segment { q0: state.q, v: step.velocity, h };
    let k = system.on(&segment)?.legendre_derivatives()?;
    let singular = StepError::DependentConstraints { constraint: 0 };
    let kappa = OnConstraints::<L, R, N, M>::new(system, state)?.multipliers(&segment).ok_or(singular)?;
    let onto = onto_constraints::<L, N, M>(system, state)?;
    let (raw, by_p) = before_momentum(system, &segment, &k, &kappa)?;
    // From here on at the end, `h` later.
    system.later(h, |system| {
        let end = &step.state;
        let v = end.velocity(system)?;
        let at = AtPoint::<_, N, M>::of(system, &end.q, Inertia::at(system, &end.q, &v)?)?;
        // μ, by which p1 was moved.
        let moved = end.p - k.momenta.p1;
        let mu = at.complement.solve(&(at.answers.transpose() * moved));
        let bent = system.constraint_curvature(&end.q, &mu);
        let by_q = slope_of_rates::<L, N, M>(system, &end.q, &v, &at);
        let held = |dq: &SMatrix<L::Scalar, N, N>, dp: SMatrix<L::Scalar, N, N>| {
            let dp = dp + bent * dq;
            let left = by_q * dq + at.answers.transpose() * dp;
            dp - at.gradients.transpose() * by_columns(&left, |left| at.complement.solve(left))
        };
        let on_constraints = PhaseMatrix {
            q_by_q: raw,
            q_by_p: by_p,
            p_by_q: held(&raw, k.p1_by_q0 + k.p1_by_q1 * raw),
            p_by_p: held(&by_p, k.p1_by_q1 * by_p),
        };
        Ok(on_constraints * onto)
    })
}

/// ∂q1/∂q0 and ∂q1/∂p0 along N.
#[expect(clippy::type_complexity, reason = "two matrices")]
fn before_momentum<L, const N: usize, const M: usize>(
    system: &L,
    segment: &Segment<L::Scalar, N>,
    k: &LegendreDerivatives<L::Scalar, N>,
    kappa: &SVector<L::Scalar, M>,
) -> Result<(SMatrix<L::Scalar, N, N>, SMatrix<L::Scalar, N, N>), StepError>
where
    L: Constrained<N, M>,
{
    let free = invert(&k.p0_by_q1)?;
    let (_, first) = system.constraint_gradients(&segment.q0);
    let (_, last) = system.constraint_gradients(&segment.end());
    let answers = free * first.transpose();
    let singular = StepError::DependentConstraints { constraint: 0 };
    let complement = Complement::of(&(last * answers)).ok_or(singular)?;
    let by_p = by_columns(&free, |column| column - answers * complement.solve(&(last * column)));
    let by_q = -(by_p * (k.p0_by_q0 - system.constraint_curvature(&segment.q0, kappa)));
    Ok((by_q, by_p))
}

/// The derivative of the nearest state on N, at a state on N.
fn onto_constraints<L, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> Result<PhaseMatrix<L::Scalar, N>, StepError>
where
    L: Constrained<N, M>,
{
    let v = state.velocity(system)?;
    let at = AtPoint::<_, N, M>::of(system, &state.q, Inertia::at(system, &state.q, &v)?)?;
    let by_q = slope_of_rates::<L, N, M>(system, &state.q, &v, &at);
    let one = SMatrix::<L::Scalar, N, N>::identity();
    let solved = |left: &SMatrix<L::Scalar, M, N>| by_columns(left, |left| at.complement.solve(left));
    let q_by_q = one - at.answers * solved(&at.gradients);
    let p_by_p = one - at.gradients.transpose() * solved(&at.answers.transpose());
    let p_by_q = -(at.gradients.transpose() * solved(&(by_q * q_by_q)));
    Ok(PhaseMatrix { q_by_q, q_by_p: nalgebra::zero(), p_by_q, p_by_p })
}

/// ∂/∂q of G(q)·v(q, p), at fixed p: ∂²gₖ/∂q² v by rows, and G ∂v/∂q.
fn slope_of_rates<L, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
    at: &AtPoint<L::Scalar, N, M>,
) -> SMatrix<L::Scalar, M, N>
where
    L: Constrained<N, M>,
{
    let velocity_by_q = system.lagrangian_derivatives(q, v).d12 * at.answers;
    let one = SMatrix::<L::Scalar, M, M>::identity();
    let bent = by_columns(&one, |one| system.constraint_curvature(q, one) * v);
    (bent - velocity_by_q).transpose()
}
