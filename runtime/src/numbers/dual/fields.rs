//! Derivatives of fields on the configuration space: functions of q alone.
//!
//! As those of functions of (q, v), they take the function once for each kind of number.

use core::array;

use nalgebra::{SMatrix, SVector};

use super::Real;
use super::primitive::Primitive;
use super::seeds::{First, Second, entries, first, second, seed};
use super::singular::{self, Alone, AloneFirst, has_nan};

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
    alone: impl Fn([Real<AloneFirst<F>>; N]) -> [Real<AloneFirst<F>>; N],
) -> SMatrix<F, N, N> {
    let rows = f(seeded(q)).map(|component| entries(component.0.eps));
    let jacobian = SMatrix::from_fn(|i, j| rows[i][j]);
    if has_nan(&jacobian) { singular::covector_derivatives(q, q, |q, _| alone(q)).0 } else { jacobian }
}

/// dS(q) of the scalar field `f`.
#[inline]
pub fn differential<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    f: impl Fn([Real<First<F, N>>; N]) -> Real<First<F, N>>,
    alone: impl Fn([Real<Alone<F>>; N]) -> Real<Alone<F>>,
) -> SVector<F, N> {
    let differential = entries(f(seeded(q)).0.eps);
    if has_nan(&differential) { singular::gradient(q, q, |q, _| alone(q)).d1 } else { differential }
}

/// Second derivatives of the scalar field `f`.
#[inline]
pub fn hessian<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    f: impl Fn([Real<Second<F, N>>; N]) -> Real<Second<F, N>>,
    alone: impl Fn([Real<Alone<F>>; N]) -> Real<Alone<F>>,
) -> SMatrix<F, N, N> {
    let one = nalgebra::one();
    let hessian = entries(f(array::from_fn(|i| second(q[i], seed(i, one), seed(i, one)))).0.eps1eps2);
    if has_nan(&hessian) { singular::derivatives(q, q, |q, _| alone(q)).2 } else { hessian }
}
