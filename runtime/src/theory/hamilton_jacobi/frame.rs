//! The tangent frame of a carried section.

use nalgebra::SMatrix;

use crate::numbers::Scalar;
use crate::step::PhaseMatrix;

/// The tangent frame (Q, P) of a carried section: derivatives of (q_k, p_k) by the label, each N×N.
///
/// QᵀP − PᵀQ is 0 where the carried section is closed, and Dγ_k = P Q⁻¹ but on a caustic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<S, const N: usize> {
    /// Q = ∂q_k/∂x.
    pub q: SMatrix<S, N, N>,
    /// P = ∂p_k/∂x.
    pub p: SMatrix<S, N, N>,
}

impl<S: Scalar, const N: usize> Frame<S, N> {
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
