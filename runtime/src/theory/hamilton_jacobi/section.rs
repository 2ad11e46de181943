//! The parts of a candidate solution: sections of T*Q and maps of Q.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;
use crate::system::ScalarField;

/// A section γ: Q → T*Q, q ↦ (q, γ(q)).
///
/// Every [`ScalarField`] S is one, γ = dS; a section that is no differential implements the trait itself.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a section of T*ℝ^{N}",
    label = "neither a section γ nor a function S with γ = dS",
    note = "implement `ScalarField<{N}>` for a generating function, or `Section<{N}>` for a covector field that is no gradient"
)]
pub trait Section<const N: usize> {
    /// `f64` or `f32`.
    type Scalar: Scalar;

    /// γ(q), shape N.
    fn covector(&self, q: &SVector<Self::Scalar, N>) -> SVector<Self::Scalar, N>;

    /// Dγ(q), shape N×N: entry (i, j) is ∂γᵢ/∂qⱼ. Symmetric everywhere iff γ is closed.
    fn jacobian(&self, q: &SVector<Self::Scalar, N>) -> SMatrix<Self::Scalar, N, N>;
}

impl<F: ScalarField<N>, const N: usize> Section<N> for F {
    type Scalar = F::Scalar;

    fn covector(&self, q: &SVector<Self::Scalar, N>) -> SVector<Self::Scalar, N> {
        self.gradient(q)
    }

    fn jacobian(&self, q: &SVector<Self::Scalar, N>) -> SMatrix<Self::Scalar, N, N> {
        self.hessian(q)
    }
}

/// A map F: Q → Q, such as the F_k of a candidate (F_k, γ_k).
pub trait ConfigurationMap<const N: usize> {
    /// `f64` or `f32`.
    type Scalar: Scalar;

    /// F(q), shape N.
    fn image(&self, q: &SVector<Self::Scalar, N>) -> SVector<Self::Scalar, N>;

    /// DF(q), shape N×N: entry (i, j) is ∂Fᵢ/∂qⱼ.
    fn jacobian(&self, q: &SVector<Self::Scalar, N>) -> SMatrix<Self::Scalar, N, N>;
}

/// |γ| + |Dγ||q|: the size of γ(q) with what the rounding of q makes of it.
pub(super) fn magnitude<G: Section<N>, const N: usize>(
    section: &G,
    q: &SVector<G::Scalar, N>,
) -> SVector<G::Scalar, N> {
    section.covector(q).abs() + section.jacobian(q).abs() * q.abs()
}
