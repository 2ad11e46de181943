//! Derivatives of functions of (q, v): seeds in, parts out.
//!
//! Each takes the function twice, once for each kind of number: with all derivatives at once, and with those
//! of one pair of variables, for points where some of the former are not numbers (see [`singular`]).

use core::array;

use nalgebra::{SMatrix, SVector};
use num_dual::{Derivative, DualSVec};

use super::Real;
use super::primitive::Primitive;
use super::seeds::{First, Second, block, entries, first, second, seed};
use super::singular::{self, Alone, AloneFirst, has_nan};
use crate::numbers::{CovectorDerivatives, Derivatives, Direction, Gradient, Variations};

/// The most variables whose derivatives one number carries all at once.
///
/// By k variables it holds k² entries, which every operation of a body moves: twelve are 1.2 kB. Beyond, a
/// function is evaluated once for each pair of variables, whose numbers are small: the stack holds them,
/// whatever n is.
const TOGETHER: usize = 12;

/// Value, ∂f/∂q and ∂f/∂v of `f`.
///
/// q is seeded in the first part and v in the second, so that what depends on one alone carries N derivatives
/// and not 2N; the mixed part is not read, and so not computed.
#[inline]
pub fn gradient<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<Second<F, N>>; N], [Real<Second<F, N>>; N]) -> Real<Second<F, N>>,
    alone: impl Fn([Real<Alone<F>>; N], [Real<Alone<F>>; N]) -> Real<Alone<F>>,
) -> Gradient<F, N> {
    if N > TOGETHER {
        return singular::gradient(q, v, alone);
    }
    let gradient = gradient_together(q, v, f);
    if has_nan(&gradient.d1) || has_nan(&gradient.d2) {
        return singular::gradient(q, v, alone);
    }
    gradient
}

// The numbers that carry all derivatives have functions, and so frames on the stack, of their own.

#[inline]
fn gradient_together<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<Second<F, N>>; N], [Real<Second<F, N>>; N]) -> Real<Second<F, N>>,
) -> Gradient<F, N> {
    let one = nalgebra::one();
    let qs = array::from_fn(|i| second(q[i], seed(i, one), Derivative(None)));
    let vs = array::from_fn(|i| second(v[i], Derivative(None), seed(i, one)));
    let f = f(qs, vs).0;
    Gradient { value: f.re, d1: entries(f.eps1), d2: entries(f.eps2).transpose() }
}

/// Value, first and second derivatives of `f`; M = 2N.
#[inline]
pub fn derivatives<F: Primitive, const N: usize, const M: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<Second<F, M>>; N], [Real<Second<F, M>>; N]) -> Real<Second<F, M>>,
    alone: impl Fn([Real<Alone<F>>; N], [Real<Alone<F>>; N]) -> Real<Alone<F>>,
) -> Derivatives<F, N> {
    const { assert!(M == 2 * N) };
    let (value, first, second) = if M > TOGETHER {
        singular::derivatives::<F, N, M>(q, v, alone)
    } else {
        let (value, first, second) = derivatives_together::<F, N, M>(q, v, f);
        if has_nan(&first) || has_nan(&second) {
            singular::derivatives(q, v, alone)
        } else {
            (value, first, second)
        }
    };
    Derivatives {
        value,
        d1: block(&first, 0, 0),
        d2: block(&first, N, 0),
        d11: block(&second, 0, 0),
        d12: block(&second, 0, N),
        d22: block(&second, N, N),
    }
}

#[inline]
fn derivatives_together<F: Primitive, const N: usize, const M: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<Second<F, M>>; N], [Real<Second<F, M>>; N]) -> Real<Second<F, M>>,
) -> (F, SVector<F, M>, SMatrix<F, M, M>) {
    let one = nalgebra::one();
    let qs = array::from_fn(|i| second(q[i], seed(i, one), seed(i, one)));
    let vs = array::from_fn(|i| second(v[i], seed(N + i, one), seed(N + i, one)));
    let f = f(qs, vs).0;
    (f.re, entries(f.eps1), entries(f.eps1eps2))
}

/// Derivatives of `f` along `minus` and `plus`, and the mixed one.
#[inline]
pub fn variations<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    minus: Direction<F>,
    plus: Direction<F>,
    f: impl Fn([Real<Second<F, N>>; N], [Real<Second<F, N>>; N]) -> Real<Second<F, N>>,
    alone: impl Fn([Real<Alone<F>>; N], [Real<Alone<F>>; N]) -> Real<Alone<F>>,
) -> Variations<F, N> {
    if N > TOGETHER {
        return singular::variations(q, v, minus, plus, alone);
    }
    let variations = variations_together(q, v, minus, plus, f);
    if has_nan(&variations.minus) || has_nan(&variations.plus) || has_nan(&variations.mixed) {
        return singular::variations(q, v, minus, plus, alone);
    }
    variations
}

#[inline]
fn variations_together<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    minus: Direction<F>,
    plus: Direction<F>,
    f: impl Fn([Real<Second<F, N>>; N], [Real<Second<F, N>>; N]) -> Real<Second<F, N>>,
) -> Variations<F, N> {
    let qs = array::from_fn(|i| second(q[i], seed(i, minus.first), seed(i, plus.first)));
    let vs = array::from_fn(|i| second(v[i], seed(i, minus.second), seed(i, plus.second)));
    let f = f(qs, vs).0;
    Variations { minus: entries(f.eps1), plus: entries(f.eps2).transpose(), mixed: entries(f.eps1eps2) }
}

/// Value and Jacobians of the covector-valued `f`; M = 2N.
#[inline]
pub fn covector_derivatives<F: Primitive, const N: usize, const M: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    f: impl Fn([Real<First<F, M>>; N], [Real<First<F, M>>; N]) -> [Real<First<F, M>>; N],
    alone: impl Fn([Real<AloneFirst<F>>; N], [Real<AloneFirst<F>>; N]) -> [Real<AloneFirst<F>>; N],
) -> CovectorDerivatives<F, N> {
    const { assert!(M == 2 * N) };
    let one = nalgebra::one();
    let f = f(array::from_fn(|i| first(q[i], i, one)), array::from_fn(|i| first(v[i], N + i, one)));
    let rows = f.map(|component| entries(component.0.eps));
    let mut d1 = SMatrix::from_fn(|i, j| rows[i][j]);
    let mut d2 = SMatrix::from_fn(|i, j| rows[i][N + j]);
    if has_nan(&d1) || has_nan(&d2) {
        (d1, d2) = singular::covector_derivatives(q, v, alone);
    }
    CovectorDerivatives { value: SVector::from_fn(|i, _| f[i].0.re), d1, d2 }
}

/// Value of the covector-valued `f` and its derivative along `direction`.
#[inline]
pub fn covector_variation<F: Primitive, const N: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    direction: Direction<F>,
    f: impl Fn([Real<First<F, N>>; N], [Real<First<F, N>>; N]) -> [Real<First<F, N>>; N],
    alone: impl Fn([Real<AloneFirst<F>>; N], [Real<AloneFirst<F>>; N]) -> [Real<AloneFirst<F>>; N],
) -> (SVector<F, N>, SMatrix<F, N, N>) {
    let qs = array::from_fn(|i| first(q[i], i, direction.first));
    let vs = array::from_fn(|i| first(v[i], i, direction.second));
    let f = f(qs, vs);
    let rows = f.map(|component| entries(component.0.eps));
    let mut along = SMatrix::from_fn(|i, j| rows[i][j]);
    if has_nan(&along) {
        along = singular::covector_variation(q, v, direction, alone);
    }
    (SVector::from_fn(|i, _| f[i].0.re), along)
}

/// The derivative of the covector-valued `f` by the input u, q and v held.
#[inline]
pub fn by_input<F: Primitive, const N: usize, const M: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    u: &[F; M],
    f: impl Fn([Real<First<F, M>>; N], [Real<First<F, M>>; N], [Real<First<F, M>>; M]) -> [Real<First<F, M>>; N],
) -> SMatrix<F, N, M> {
    let [q, v] = [q, v].map(|vector| array::from_fn(|i| Real(DualSVec::from_re(vector[i]))));
    let rows = f(q, v, array::from_fn(|j| first(u[j], j, nalgebra::one()))).map(|row| entries(row.0.eps));
    SMatrix::from_fn(|i, j| rows[i][j])
}
