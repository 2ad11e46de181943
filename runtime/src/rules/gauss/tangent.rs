//! How a solved step follows what it depends on: exact, by the implicit function theorem.
//!
//! The stages' equations r(V, z) = 0 hold for every z, such as q0, p0, an input or a parameter, so that J
//! dV = −∂r/∂z dz with the matrix J = ∂r/∂V of all stages, factored once for all columns. With μ_i, g_i what
//! z itself moves in ∂L/∂v and G at a stage:
//!
//! ```text
//! J dV = dp0 − μ_i − B_i dq0 + h Σ_j a_ij (g_j + K_j dq0),   dQ_i = dq0 + h Σ_j a_ij dV_j
//! dq1 = dq0 + h Σ b_j dV_j,                                  dp1 = dp0 + h Σ b_j (K_j dQ_j + C_j dV_j + g_j)
//! ```
//!
//! No step is inverted for its end: A = ∂(q1, p1)/∂(q0, p0) exists where ∂q1/∂p0 is singular as well.

use core::array;

use nalgebra::SMatrix;

use super::linearised::{Factored, Local, StageColumns};
use super::problem::Problem;
use crate::numbers::Scalar;
use crate::step::{PhaseMatrix, Quantity, StateBy, StepError};
use crate::system::ForcedLagrangian;

/// The changes that K quantities make by themselves, the stages' velocities being held.
pub(super) struct Source<T, const N: usize, const S: usize, const K: usize> {
    /// In q0.
    pub(super) q0: SMatrix<T, N, K>,
    /// In p0.
    pub(super) p0: SMatrix<T, N, K>,
    /// In ∂L/∂v at the stages.
    pub(super) momentum: StageColumns<T, N, S, K>,
    /// In G at the stages.
    pub(super) rate: StageColumns<T, N, S, K>,
}

impl<T: Scalar, const N: usize, const S: usize, const K: usize> Source<T, N, S, K> {
    pub(super) fn none() -> Self {
        let zero = SMatrix::zeros();
        Self { q0: zero, p0: zero, momentum: [zero; S], rate: [zero; S] }
    }

    /// How the step follows what moves, with the equations of its stages linearised.
    pub(super) fn tangent<L: ForcedLagrangian<N, Scalar = T>>(
        &self,
        problem: &Problem<'_, L, N, S>,
        locals: &[Local<T, N>; S],
        factored: &Factored<T, N, S>,
    ) -> Result<Tangent<T, N, S, K>, StepError> {
        let rate: StageColumns<T, N, S, K> = array::from_fn(|j| self.rate[j] + locals[j].rate_by_q * self.q0);
        let v = factored.solve(&array::from_fn(|i| {
            let own = self.p0 - self.momentum[i] - locals[i].momentum_by_q * self.q0;
            (0..S).fold(own, |sum, j| sum + rate[j] * problem.share(i, j))
        }));
        let q: StageColumns<T, N, S, K> =
            array::from_fn(|i| (0..S).fold(self.q0, |sum, j| sum + v[j] * problem.share(i, j)));
        let mut end = StateBy { q: self.q0, p: self.p0 };
        for (i, local) in locals.iter().enumerate() {
            end.q += v[i] * problem.steps[i];
            end.p += (local.rate_by_q * q[i] + local.rate_by_v * v[i] + self.rate[i]) * problem.steps[i];
        }
        StepError::require_finite(&end.q, Quantity::Derivatives)?;
        StepError::require_finite(&end.p, Quantity::Derivatives)?;
        Ok(Tangent { q, v, end })
    }
}

/// Derivatives of a step and of its stages by K quantities.
#[derive(Clone, Copy)]
pub(super) struct Tangent<T, const N: usize, const S: usize, const K: usize> {
    /// ∂Q_i.
    pub(super) q: StageColumns<T, N, S, K>,
    /// ∂V_i.
    pub(super) v: StageColumns<T, N, S, K>,
    /// ∂(q1, p1).
    pub(super) end: StateBy<T, N, K>,
}

impl<T: Scalar, const N: usize, const S: usize, const K: usize> Tangent<T, N, S, K> {
    /// The derivatives by J quantities that move the K by `factor`, added to `own`.
    pub(super) fn carried<const J: usize>(
        &self,
        factor: &SMatrix<T, K, J>,
        own: Option<&Tangent<T, N, S, J>>,
    ) -> Tangent<T, N, S, J> {
        let zero = SMatrix::zeros();
        let nothing = Tangent { q: [zero; S], v: [zero; S], end: StateBy { q: zero, p: zero } };
        let own = own.unwrap_or(&nothing);
        Tangent {
            q: array::from_fn(|i| own.q[i] + self.q[i] * factor),
            v: array::from_fn(|i| own.v[i] + self.v[i] * factor),
            end: StateBy { q: own.end.q + self.end.q * factor, p: own.end.p + self.end.p * factor },
        }
    }
}

/// Derivatives of a step by the state that it starts from.
pub(super) struct ByState<T, const N: usize, const S: usize> {
    pub(super) q: Tangent<T, N, S, N>,
    pub(super) p: Tangent<T, N, S, N>,
}

impl<T: Scalar, const N: usize, const S: usize> ByState<T, N, S> {
    /// A.
    pub(super) fn matrix(&self) -> PhaseMatrix<T, N> {
        PhaseMatrix { q_by_q: self.q.end.q, q_by_p: self.p.end.q, p_by_q: self.q.end.p, p_by_p: self.p.end.p }
    }
}
