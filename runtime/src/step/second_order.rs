//! Second derivatives of the step, contracted with a covector: what second-order optimal control and
//! estimation ask for.
//!
//! With λ = (λ_q, λ_p) a covector at (q1, p1), the function λ·(q1, p1) of z = (q0, p0, u) has the second
//! derivatives
//!
//! ```text
//! ∂²(λ·(q1, p1))/∂z² = Dᵀ ∂²Φ D,   Φ(q0, q1, u) = μ·p0(q0, q1, u) + λ_p·p1(q0, q1, u),   D = ∂(q0, q1, u)/∂z
//! μ = −K01⁻ᵀ (λ_q + K11ᵀ λ_p)
//! ```
//!
//! by the implicit function theorem: μ is what makes Φ + λ_q·q1 stationary in q1, so that the second
//! derivatives of q1 itself drop out. On a segment Φ is a sum over L, R and f of their derivatives along one
//! direction, whose Hessians the engines give: third derivatives of L and R appear contracted alone.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Hessian, Scalar};
use crate::step::{LegendreDerivatives, Linearizable, State, StepError};
use crate::system::SecondOrder;

/// Second derivatives of the step of a system by rule `R`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no second derivatives of its step by `{R}`",
    label = "no second derivatives",
    note = "ask for them in the attribute: `#[rayleigh_system(step_derivatives = second)]`"
)]
pub trait DiscreteSecondOrder<R, const N: usize, const M: usize>:
    Linearizable<R, N> + SecondOrder<N, M>
{
    /// Second derivatives of `covector`.q·q1 + `covector`.p·p1 by (q0, p0, u).
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn hessian(
        at: &Self::Linearized<'_>,
        covector: &State<Self::Scalar, N>,
    ) -> Result<StepHessian<Self::Scalar, N, M>, StepError>;
}

impl<S: Scalar, const N: usize> LegendreDerivatives<S, N> {
    /// Second derivatives of the step, with K01⁻¹, ∂p0/∂u and, as a function of the covectors at both ends,
    /// the second derivatives of at_start·p0 + at_end·p1 at hand.
    pub(crate) fn step_hessian<const M: usize>(
        &self,
        by_p: &SMatrix<S, N, N>,
        p0_by_input: &SMatrix<S, N, M>,
        covector: &State<S, N>,
        momenta_along: impl FnOnce([&SVector<S, N>; 2]) -> Hessian<S, N, M>,
    ) -> StepHessian<S, N, M> {
        // ∂q1/∂q0, ∂q1/∂u.
        let by_q = -(by_p * self.p0_by_q0);
        let by_u = -(by_p * p0_by_input);
        let at_start = -(by_p.transpose() * (covector.q + self.p1_by_q1.transpose() * covector.p));
        let Hessian { d11, d12, d22, d1u, d2u, duu } = momenta_along([&at_start, &covector.p]);
        // ∂²Φ/∂q1∂z with q1 carried along.
        let carried_u = d2u + d22 * by_u;
        let carried_q = d12.transpose() + d22 * by_q;
        StepHessian {
            qq: d11 + d12 * by_q + by_q.transpose() * carried_q,
            qp: carried_q.transpose() * by_p,
            pp: by_p.transpose() * d22 * by_p,
            qu: d1u + d12 * by_u + by_q.transpose() * carried_u,
            pu: by_p.transpose() * carried_u,
            uu: duu + d2u.transpose() * by_u + by_u.transpose() * carried_u,
        }
    }
}

/// Second derivatives of λ·(q1, p1) by (q0, p0, u); the formula stands above.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct StepHessian<S, const N: usize, const M: usize = 0> {
    /// By q0 twice, symmetric.
    pub qq: SMatrix<S, N, N>,
    /// By q0 (rows) and p0.
    pub qp: SMatrix<S, N, N>,
    /// By p0 twice, symmetric.
    pub pp: SMatrix<S, N, N>,
    /// By q0 (rows) and u.
    pub qu: SMatrix<S, N, M>,
    /// By p0 (rows) and u.
    pub pu: SMatrix<S, N, M>,
    /// By u twice, symmetric.
    pub uu: SMatrix<S, M, M>,
}
