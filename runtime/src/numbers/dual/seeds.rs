//! Numbers seeded with derivatives by some variables, and what is read off them.

use nalgebra::SMatrix;
use num_dual::{Derivative, DualSVec};

use super::primitive::Primitive;
use super::{HyperDualSVec, Part, Real};

/// First derivatives by M seeds.
pub(super) type First<F, const M: usize> = DualSVec<F, M>;

/// First derivatives by two families of M seeds, and the mixed second ones.
pub(super) type Second<F, const M: usize> = HyperDualSVec<F, M, M>;

/// `factor` in entry `index`, zero elsewhere.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn seed<F: Primitive, const R: usize, const C: usize>(index: usize, factor: F) -> Part<F, R, C> {
    let mut entries = SMatrix::zeros();
    entries[index] = factor;
    Derivative(Some(entries))
}

#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn first<F: Primitive, const M: usize>(value: F, index: usize, factor: F) -> Real<First<F, M>> {
    Real(DualSVec { re: value, eps: seed(index, factor) })
}

#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn second<F: Primitive, const M: usize>(
    value: F,
    eps1: Part<F, M, 1>,
    eps2: Part<F, 1, M>,
) -> Real<Second<F, M>> {
    Real(HyperDualSVec { re: value, eps1, eps2, eps1eps2: Derivative(None) })
}

/// The entries, zeros where absent.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn entries<F: Primitive, const R: usize, const C: usize>(part: Part<F, R, C>) -> SMatrix<F, R, C> {
    part.0.unwrap_or_else(SMatrix::zeros)
}

/// The block of `matrix` that starts at (`row`, `column`).
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn block<F: Primitive, const R: usize, const C: usize, const A: usize, const B: usize>(
    matrix: &SMatrix<F, A, B>,
    row: usize,
    column: usize,
) -> SMatrix<F, R, C> {
    SMatrix::from_fn(|i, j| matrix[(row + i, column + j)])
}
