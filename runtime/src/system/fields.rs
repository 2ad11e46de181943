//! Functions on the configuration space that the checkers are given: generators of symmetries, generating
//! functions.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;

/// A vector field ξ on Q = ℝᴺ, such as the generator of a symmetry.
pub trait VectorField<const N: usize> {
    /// `f64` or `f32`.
    type Scalar: Scalar;

    /// ξ(q), shape N.
    fn vector(&self, q: &SVector<Self::Scalar, N>) -> SVector<Self::Scalar, N>;

    /// Dξ(q), shape N×N: entry (i, j) is ∂ξᵢ/∂qⱼ.
    fn jacobian(&self, q: &SVector<Self::Scalar, N>) -> SMatrix<Self::Scalar, N, N>;
}

/// A function S on Q = ℝᴺ, such as a generating function.
pub trait ScalarField<const N: usize> {
    /// `f64` or `f32`.
    type Scalar: Scalar;

    /// S(q).
    fn value(&self, q: &SVector<Self::Scalar, N>) -> Self::Scalar;

    /// dS(q), shape N.
    fn gradient(&self, q: &SVector<Self::Scalar, N>) -> SVector<Self::Scalar, N>;

    /// Second derivatives of S at q, shape N×N, symmetric.
    fn hessian(&self, q: &SVector<Self::Scalar, N>) -> SMatrix<Self::Scalar, N, N>;
}
