//! Derivatives of fields on the configuration space: functions of q alone.

use core::array;

use nalgebra::{SMatrix, SVector};

use super::{First, Primitive, Real, Second, entries, first, second, seed};

/// qᵢ with the derivative eᵢ.
#[inline]
fn seeded<F: Primitive, const N: usize>(q: &SVector<F, N>) -> [Real<First<F, N>>; N] {
    array::from_fn(|i| first(q[i], i, nalgebra::one()))
}

/// Dξ(q), entry (i, j) = ∂ξᵢ/∂qⱼ, of the vector field `f`.
#[inline]
pub fn jacobian<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    f: impl Fn([Real<First<F, N>>; N]) -> [Real<First<F, N>>; N],
) -> SMatrix<F, N, N> {
    let rows = f(seeded(q)).map(|component| entries(component.0.eps));
    SMatrix::from_fn(|i, j| rows[i][j])
}

/// dS(q) of the scalar field `f`.
#[inline]
pub fn differential<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    f: impl Fn([Real<First<F, N>>; N]) -> Real<First<F, N>>,
) -> SVector<F, N> {
    entries(f(seeded(q)).0.eps)
}

/// Second derivatives of the scalar field `f`.
#[inline]
pub fn hessian<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    f: impl Fn([Real<Second<F, N>>; N]) -> Real<Second<F, N>>,
) -> SMatrix<F, N, N> {
    let one = nalgebra::one();
    entries(f(array::from_fn(|i| second(q[i], seed(i, one), seed(i, one)))).0.eps1eps2)
}
