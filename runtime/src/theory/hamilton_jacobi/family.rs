//! Families of generating functions S(q; λ).

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;
use crate::system::ScalarField;

/// A family of functions S(q; λ) with as many parameters as coordinates.
pub trait GeneratingFamily<const N: usize> {
    /// `f64` or `f32`.
    type Scalar: Scalar;

    /// S(q; λ).
    fn value(&self, q: &SVector<Self::Scalar, N>, lambda: &SVector<Self::Scalar, N>) -> Self::Scalar;

    /// ∂S/∂q, shape N.
    fn gradient(
        &self,
        q: &SVector<Self::Scalar, N>,
        lambda: &SVector<Self::Scalar, N>,
    ) -> SVector<Self::Scalar, N>;

    /// ∂²S/∂q∂q, shape N×N, symmetric.
    fn hessian(
        &self,
        q: &SVector<Self::Scalar, N>,
        lambda: &SVector<Self::Scalar, N>,
    ) -> SMatrix<Self::Scalar, N, N>;

    /// ∂S/∂λ, shape N.
    fn by_parameters(
        &self,
        q: &SVector<Self::Scalar, N>,
        lambda: &SVector<Self::Scalar, N>,
    ) -> SVector<Self::Scalar, N>;

    /// ∂²S/∂q∂λ, shape N×N: entry (i, j) is ∂²S/∂qᵢ∂λⱼ.
    fn mixed(
        &self,
        q: &SVector<Self::Scalar, N>,
        lambda: &SVector<Self::Scalar, N>,
    ) -> SMatrix<Self::Scalar, N, N>;
}

/// S(·; λ), one member of a family: a function of q.
#[derive(Clone, Copy, Debug)]
pub struct FamilyMember<'a, F, S, const N: usize> {
    /// S.
    pub family: &'a F,
    /// λ.
    pub lambda: SVector<S, N>,
}

impl<S: Scalar, F: GeneratingFamily<N, Scalar = S>, const N: usize> ScalarField<N>
    for FamilyMember<'_, F, S, N>
{
    type Scalar = S;

    fn value(&self, q: &SVector<S, N>) -> S {
        self.family.value(q, &self.lambda)
    }

    fn gradient(&self, q: &SVector<S, N>) -> SVector<S, N> {
        self.family.gradient(q, &self.lambda)
    }

    fn hessian(&self, q: &SVector<S, N>) -> SMatrix<S, N, N> {
        self.family.hessian(q, &self.lambda)
    }
}
