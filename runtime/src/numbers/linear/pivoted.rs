//! Matrices made ready to solve with whatever row exchanges they need.

use nalgebra::{SMatrix, SVector};

use super::{Factored, NewtonMatrix};
use crate::numbers::Scalar;

/// A matrix made ready to solve with: in its own form, or dense where that form has no room for the row
/// exchanges that it needs, as a band between bodies whose dashpot outweighs their mass by 10³ and more.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Pivoted<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> {
    InForm(M::Factored),
    Dense(<SMatrix<S, N, N> as NewtonMatrix<S, N>>::Factored),
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> Pivoted<S, M, N> {
    /// Of the `matrix`; nothing if it is singular.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(crate) fn of(matrix: &M) -> Option<Self> {
        match matrix.factored() {
            Some(factored) => Some(Self::InForm(factored)),
            None => dense(matrix).map(Self::Dense),
        }
    }
}

#[cold]
#[inline(never)]
fn dense<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    matrix: &M,
) -> Option<<SMatrix<S, N, N> as NewtonMatrix<S, N>>::Factored> {
    matrix.dense().factored()
}

impl<S: Scalar, M: NewtonMatrix<S, N>, const N: usize> Factored<S, N> for Pivoted<S, M, N> {
    #[inline]
    fn solve(&self, right: &SVector<S, N>) -> SVector<S, N> {
        match self {
            Self::InForm(factored) => factored.solve(right),
            Self::Dense(factored) => factored.solve(right),
        }
    }

    #[inline]
    fn solve_columns<const K: usize>(&self, right: &SMatrix<S, N, K>) -> SMatrix<S, N, K> {
        match self {
            Self::InForm(factored) => factored.solve_columns(right),
            Self::Dense(factored) => factored.solve_columns(right),
        }
    }
}
