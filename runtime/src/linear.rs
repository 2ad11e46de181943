//! Linear systems of the size of the configuration space.
//!
//! Own code because a step must not panic, must not allocate, and must tell a singular matrix from a badly scaled one;
//! nalgebra's factorisations do none of the three for every N.

use nalgebra::{SMatrix, SVector};

use crate::Scalar;

mod banded;
mod dense;

pub use banded::Banded;

/// A matrix that has no solution to working precision: the column whose pivot is lost to rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Singular {
    /// The column.
    pub column: usize,
}

mod sealed {
    pub trait Sealed {}
    impl<S, const N: usize> Sealed for nalgebra::SMatrix<S, N, N> {}
    impl<S, const N: usize, const W: usize> Sealed for super::Banded<S, N, W> {}
}

/// The form in which a system keeps its Newton matrix: dense, [`SMatrix`], or [`Banded`] where coordinates couple to near
/// ones only.
pub trait NewtonMatrix<S: Scalar, const N: usize>: Copy + sealed::Sealed {
    /// The matrix without entries.
    fn zero() -> Self;

    /// The entry at `row` and `column`, 0 outside the band.
    fn entry(&self, row: usize, column: usize) -> S;

    /// All entries, with the zeros outside the band.
    fn dense(&self) -> SMatrix<S, N, N> {
        SMatrix::from_fn(|row, column| self.entry(row, column))
    }

    /// The solution x of A x = `right`.
    ///
    /// # Errors
    /// [`Singular`] if rounding has taken every digit of a pivot.
    fn solve(&self, right: &SVector<S, N>) -> Result<SVector<S, N>, Singular>;

    /// Σⱼ |Aᵢⱼ||vⱼ| for each i: how large the terms of A v are.
    fn magnitudes(&self, v: &SVector<S, N>) -> SVector<S, N>;

    /// Whether every entry of the row is a finite number.
    fn row_is_finite(&self, row: usize) -> bool {
        (0..N).all(|column| self.entry(row, column).is_finite())
    }
}

/// The solution x of `matrix` x = `right`, column by column of the right side, with one elimination.
#[inline]
pub(crate) fn solve<S: Scalar, const N: usize, const C: usize>(
    matrix: &SMatrix<S, N, N>,
    right: &SMatrix<S, N, C>,
) -> Result<SMatrix<S, N, C>, Singular> {
    dense::solve(matrix, right)
}

/// Says whether `matrix` can be solved with.
pub(crate) fn require_regular<S: Scalar, const N: usize>(matrix: &SMatrix<S, N, N>) -> Result<(), Singular> {
    matrix.solve(&SVector::zeros()).map(|_| ())
}
