//! Hessians of derivatives along a direction: third derivatives, contracted once.

use core::array;

use nalgebra::{SMatrix, SVector};
use num_dual::{Derivative, DualSVec, HyperDualVec};

use super::primitive::Primitive;
use super::seeds::{Second, block, entries, second, seed};
use super::{Dual, Real};
use crate::numbers::Hessian;

/// A number with one derivative.
type Along<F> = DualSVec<F, 1>;

/// Second derivatives by K seeds, of numbers with one derivative.
type Third<F, const K: usize> = HyperDualVec<Along<F>, nalgebra::Const<K>, nalgebra::Const<K>>;

/// Second derivatives by (q, v) of a·∂f/∂q + b·∂f/∂v; K = 2N.
#[inline]
pub fn hessian_along<F: Primitive, const N: usize, const M: usize, const K: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    [a, b]: [&SVector<F, N>; 2],
    f: impl Fn([Real<Third<F, K>>; N], [Real<Third<F, K>>; N]) -> Real<Third<F, K>>,
) -> Hessian<F, N, M>
where
    Third<F, K>: Dual<F>,
{
    const { assert!(K == 2 * N) };
    let one = Along::<F>::from_re(nalgebra::one());
    let number = |value: F, along: F, index: usize| {
        let mut column = SMatrix::<Along<F>, K, 1>::from_element(Along::from_re(nalgebra::zero()));
        column[index] = one;
        Real(HyperDualVec {
            re: DualSVec { re: value, eps: seed(0, along) },
            eps1: Derivative(Some(column)),
            eps2: Derivative(Some(column.transpose())),
            eps1eps2: Derivative(None),
        })
    };
    let f = f(array::from_fn(|i| number(q[i], a[i], i)), array::from_fn(|i| number(v[i], b[i], N + i))).0;
    let third: SMatrix<F, K, K> = match f.eps1eps2.0 {
        Some(second) => second.map(|entry| entries(entry.eps)[0]),
        None => SMatrix::zeros(),
    };
    Hessian {
        d11: block(&third, 0, 0),
        d12: block(&third, 0, N),
        d22: block(&third, N, N),
        ..Hessian::zero()
    }
}

/// Second derivatives by (q, v, u) of `vector`·f; K = 2N + M.
#[inline]
pub fn hessian_of_product<F: Primitive, const N: usize, const M: usize, const K: usize>(
    q: &SVector<F, N>,
    v: &SVector<F, N>,
    u: &[F; M],
    vector: &SVector<F, N>,
    f: impl Fn(
        [Real<Second<F, K>>; N],
        [Real<Second<F, K>>; N],
        [Real<Second<F, K>>; M],
    ) -> [Real<Second<F, K>>; N],
) -> Hessian<F, N, M> {
    const { assert!(K == 2 * N + M) };
    let one = nalgebra::one();
    let number = |value: F, index: usize| second(value, seed(index, one), seed(index, one));
    let components = f(
        array::from_fn(|i| number(q[i], i)),
        array::from_fn(|i| number(v[i], N + i)),
        array::from_fn(|i| number(u[i], 2 * N + i)),
    );
    let mut sum = SMatrix::<F, K, K>::zeros();
    for (component, factor) in components.into_iter().zip(vector.iter()) {
        sum += entries(component.0.eps1eps2) * *factor;
    }
    Hessian {
        d11: block(&sum, 0, 0),
        d12: block(&sum, 0, N),
        d22: block(&sum, N, N),
        d1u: block(&sum, 0, 2 * N),
        d2u: block(&sum, N, 2 * N),
        duu: block(&sum, 2 * N, 2 * N),
    }
}
