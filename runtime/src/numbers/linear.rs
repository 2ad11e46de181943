//! Linear systems of the size of the configuration space.
//!
//! Own code because a step must not panic, must not allocate, and must tell a singular matrix from a badly
//! scaled one; nalgebra's factorisations do none of the three for every N.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Mask, MemberVector, Scalar, Singular};

mod banded;
mod columns;
mod dense;
mod determinant;
mod pivoted;

pub use banded::Banded;
pub(crate) use columns::by_columns;
pub(crate) use dense::{FactoredDense, factored_to_half};
pub(crate) use determinant::determinant_sign;
pub(crate) use pivoted::Pivoted;

mod sealed {
    pub trait Sealed {}
    impl<S, const N: usize> Sealed for nalgebra::SMatrix<S, N, N> {}
    impl<S, const N: usize, const W: usize> Sealed for super::Banded<S, N, W> {}
}

/// The form in which a system keeps its Newton matrix: dense, [`SMatrix`], or [`Banded`] where coordinates
/// couple to near ones only.
pub trait NewtonMatrix<S: Scalar, const N: usize>: Copy + core::fmt::Debug + sealed::Sealed {
    /// The matrix made ready to solve with, more than once.
    type Factored: Factored<S, N>;

    /// W of them side by side, made ready.
    type OfMembers<const W: usize>: MatricesOfMembers<S, N, W, Matrix = Self>;

    /// The matrix made ready; nothing if it is singular, or if its form has no room for the row exchanges
    /// that it needs: [`solve`](Self::solve) tells which.
    fn factored(&self) -> Option<Self::Factored>;

    /// The matrix without entries.
    fn zero() -> Self;

    /// The entry at `row` and `column`, 0 outside the band and the matrix: nothing here panics.
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

    /// A + `factor` `other`.
    #[must_use]
    fn plus(&self, other: &Self, factor: S) -> Self;

    /// Makes rows and columns with an entry in `held` that is not 0 those of the unit matrix.
    fn hold(&mut self, held: &[S]);

    /// Whether every entry of the row is a finite number.
    fn row_is_finite(&self, row: usize) -> bool {
        (0..N).all(|column| self.entry(row, column).is_finite())
    }
}

/// A matrix made ready to solve with.
pub trait Factored<S: Scalar, const N: usize>: Copy + core::fmt::Debug {
    /// The solution x of A x = `right`.
    fn solve(&self, right: &SVector<S, N>) -> SVector<S, N>;

    /// The solution X of A X = `right`: in each column the bits of [`solve`](Self::solve).
    fn solve_columns<const K: usize>(&self, right: &SMatrix<S, N, K>) -> SMatrix<S, N, K> {
        by_columns(right, |right| self.solve(right))
    }
}

/// The matrices of W members, made ready to solve with.
pub trait MatricesOfMembers<S: Scalar, const N: usize, const W: usize>: Copy + core::fmt::Debug {
    /// The matrix of one member.
    type Matrix: NewtonMatrix<S, N>;

    /// The entries alone, as they are computed: row by row, of a band those within it.
    type Entries: Copy + core::fmt::Debug;

    /// All entries 0, in the factors too.
    fn zero() -> Self;

    /// Writes the matrix of one member.
    fn write(
        &mut self,
        member: usize,
        matrix: &Self::Matrix,
        factored: &<Self::Matrix as NewtonMatrix<S, N>>::Factored,
    );

    /// [`Factored::solve`] of each.
    fn solve(&self, right: &MemberVector<S, N, W>) -> MemberVector<S, N, W>;

    /// [`NewtonMatrix::magnitudes`] of each.
    fn magnitudes(&self, v: &MemberVector<S, N, W>) -> MemberVector<S, N, W>;

    /// [`NewtonMatrix::solve`] of each, and a mask: false for members with a matrix that has to be looked at
    /// more closely.
    fn solution(entries: &Self::Entries, right: &MemberVector<S, N, W>) -> (MemberVector<S, N, W>, Mask<W>);

    /// [`NewtonMatrix::magnitudes`] of each.
    fn magnitudes_of(entries: &Self::Entries, v: &MemberVector<S, N, W>) -> MemberVector<S, N, W>;
}

/// The entries of the matrices `M` of W members.
pub type EntriesOfMembers<M, S, const N: usize, const W: usize> =
    <<M as NewtonMatrix<S, N>>::OfMembers<W> as MatricesOfMembers<S, N, W>>::Entries;

/// a·b, entry by entry: nalgebra's is unrolled, a thousand operations to compile in every program.
#[inline]
pub(crate) fn dot<S: Scalar, const N: usize>(a: &SVector<S, N>, b: &SVector<S, N>) -> S {
    let mut sum = S::zero();
    for (a, b) in a.as_slice().iter().zip(b.as_slice()) {
        sum += *a * *b;
    }
    sum
}

/// The inverse of `matrix`, with one elimination.
pub(crate) fn inverse<S: Scalar, const N: usize>(
    matrix: &SMatrix<S, N, N>,
) -> Result<SMatrix<S, N, N>, Singular> {
    // Up to two coordinates a closed form is less work than the factors.
    let factored = if N > 2 { Some(dense::factored(matrix)?) } else { None };
    let mut inverse = SMatrix::<S, N, N>::zeros();
    for j in 0..N {
        let mut unit = SVector::<S, N>::zeros();
        unit[j] = S::one();
        let column = match &factored {
            Some(factored) => factored.solve(&unit),
            None => matrix.solve(&unit)?,
        };
        inverse.set_column(j, &column);
    }
    Ok(inverse)
}

/// [`NewtonMatrix::solve`] in one copy a program, for what is solved seldom.
///
/// # Errors
/// [`Singular`].
#[cold]
#[inline(never)]
pub(crate) fn solve_apart<S: Scalar, const N: usize>(
    matrix: &SMatrix<S, N, N>,
    right: &SVector<S, N>,
) -> Result<SVector<S, N>, Singular> {
    matrix.solve(right)
}

/// Says whether `matrix` can be solved with.
pub(crate) fn require_regular<S: Scalar, const N: usize>(matrix: &SMatrix<S, N, N>) -> Result<(), Singular> {
    solve_apart(matrix, &SVector::zeros()).map(|_| ())
}

#[cfg(test)]
mod tests;
