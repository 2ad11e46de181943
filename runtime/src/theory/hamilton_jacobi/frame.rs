//! The tangent frame of a carried section.

use nalgebra::SMatrix;

use crate::numbers::Scalar;
use crate::step::{PhaseMatrix, invert};

/// The tangent frame (Q, P) of a carried section: derivatives of (q_k, p_k) by the label, each N×N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<S, const N: usize> {
    /// Q = ∂q_k/∂x.
    pub q: SMatrix<S, N, N>,
    /// P = ∂p_k/∂x.
    pub p: SMatrix<S, N, N>,
}

impl<S: Scalar, const N: usize> Frame<S, N> {
    /// QᵀP − PᵀQ, 0 iff the carried section is closed there. No division, so that caustics do not matter.
    #[must_use]
    pub fn closedness_defect(&self) -> SMatrix<S, N, N> {
        self.q.tr_mul(&self.p) - self.p.tr_mul(&self.q)
    }

    /// Dγ_k = P Q⁻¹; `None` on a caustic, where γ_k is no section.
    #[must_use]
    pub fn section_jacobian(&self) -> Option<SMatrix<S, N, N>> {
        Some(self.p * invert(&self.q).ok()?)
    }

    /// The coordinate whose row of Q or P is not finite.
    pub(super) fn first_non_finite(&self) -> Option<usize> {
        let finite =
            |i: usize| self.q.row(i).iter().chain(self.p.row(i).iter()).all(|entry| entry.is_finite());
        (0..N).find(|i| !finite(*i))
    }

    /// The frame a step later, A (Q, P).
    #[must_use]
    pub fn carried(&self, a: &PhaseMatrix<S, N>) -> Self {
        Self { q: a.q_by_q * self.q + a.q_by_p * self.p, p: a.p_by_q * self.q + a.p_by_p * self.p }
    }
}
