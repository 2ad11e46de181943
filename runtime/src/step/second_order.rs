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

use crate::numbers::Hessian;
use crate::step::discrete::explained_on;
use crate::step::{Discrete, SolvedForVelocity, State, StepError, StepWith, invert};
use crate::system::{Lagrangian, SecondOrder};

/// The change of p0 with the input, by rule `R`: systems without an input have none of it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not say how p0 changes with its input by `{R}`",
    label = "∂p0/∂u is missing",
    note = "write `impl StartByInput<{R}, {N}, {M}> for {Self}`, whose `p0_by_input` is −∂f_d⁻/∂u"
)]
pub trait StartByInput<R, const N: usize, const M: usize>: Lagrangian<N> {
    /// ∂p0/∂u at fixed ends, on the segment from q0 with mean velocity `v`.
    fn p0_by_input(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> SMatrix<Self::Scalar, N, M>;
}

/// Of a system without an input there is nothing to say.
impl<R: SolvedForVelocity, L: Lagrangian<N>, const N: usize> StartByInput<R, N, 0> for L {
    #[inline]
    fn p0_by_input(
        &self,
        _q0: &SVector<L::Scalar, N>,
        _v: &SVector<L::Scalar, N>,
        _h: L::Scalar,
    ) -> SMatrix<L::Scalar, N, 0> {
        SMatrix::zeros()
    }
}

/// Second derivatives of both momenta of a segment by rule `R`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no second derivatives of its step by `{R}`",
    label = "no second derivatives",
    note = "ask for them in the attribute: `#[rayleigh_system(step_derivatives = second)]`"
)]
pub trait DiscreteSecondOrder<R, const N: usize, const M: usize>:
    Discrete<R, N> + SecondOrder<N, M> + StartByInput<R, N, M>
{
    /// Second derivatives by (q0, q1, u) of `at_start`·p0 + `at_end`·p1, on the segment from q0 with mean
    /// velocity `v`.
    fn momenta_along(
        &self,
        q0: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
        at_start: &SVector<Self::Scalar, N>,
        at_end: &SVector<Self::Scalar, N>,
    ) -> Hessian<Self::Scalar, N, M>;

    /// Second derivatives of the step on the segment (`q0`, `q1`):
    /// [`Discretised::step_hessian`](crate::Discretised::step_hessian).
    ///
    /// # Errors
    /// Those of [`Discrete::linearization`].
    fn step_hessian(
        &self,
        q0: &SVector<Self::Scalar, N>,
        q1: &SVector<Self::Scalar, N>,
        h: Self::Scalar,
        covector: &State<Self::Scalar, N>,
    ) -> Result<StepHessian<Self::Scalar, N, M>, StepError> {
        let k = self.legendre_derivatives(q0, q1, h);
        // ∂q1/∂p0, ∂q1/∂q0, ∂q1/∂u.
        let by_p = invert(&k.p0_by_q1).map_err(|error| explained_on(self, q0, &((q1 - q0) / h), h, error))?;
        let by_q = -(by_p * k.p0_by_q0);
        let v = (q1 - q0) / h;
        let by_u = -(by_p * self.p0_by_input(q0, &v, h));
        let at_start = -(by_p.transpose() * (covector.q + k.p1_by_q1.transpose() * covector.p));
        let phi = self.momenta_along(q0, &v, h, &at_start, &covector.p);
        let Hessian { d11, d12, d22, d1u, d2u, duu } = phi;
        // ∂²Φ/∂q1∂z with q1 carried along.
        let carried_u = d2u + d22 * by_u;
        let carried_q = d12.transpose() + d22 * by_q;
        Ok(StepHessian {
            qq: d11 + d12 * by_q + by_q.transpose() * carried_q,
            qp: carried_q.transpose() * by_p,
            pp: by_p.transpose() * d22 * by_p,
            qu: d1u + d12 * by_u + by_q.transpose() * carried_u,
            pu: by_p.transpose() * carried_u,
            uu: duu + d2u.transpose() * by_u + by_u.transpose() * carried_u,
        })
    }

    /// The step with its second derivatives:
    /// [`Discretised::step_with_hessian`](crate::Discretised::step_with_hessian).
    ///
    /// # Errors
    /// Those of [`Flow::linearized_step`](crate::step::Flow::linearized_step).
    fn step_with_hessian(
        &self,
        state: &State<Self::Scalar, N>,
        h: Self::Scalar,
        guess: Option<&SVector<Self::Scalar, N>>,
        covector: &State<Self::Scalar, N>,
    ) -> Result<StepWith<Self::Scalar, N, StepHessian<Self::Scalar, N, M>>, StepError> {
        let step = self.step(state, h, guess)?;
        Ok((step, self.step_hessian(&state.q, &step.state.q, h, covector)?))
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
