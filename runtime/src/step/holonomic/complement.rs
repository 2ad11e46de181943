//! The Schur complement of the constraints.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Factored, NewtonMatrix, Scalar};

/// The Schur complement S = G(q1) W⁻¹ G(q0)ᵀ of M constraints, made ready to solve with.
///
/// Where constraints are redundant, S is singular and the equations are consistent all the same: then
/// S + ε is factored, and solutions are refined with S, which leads to the one of least norm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Complement<S: Scalar, const M: usize> {
    factored: <SMatrix<S, M, M> as NewtonMatrix<S, M>>::Factored,
    /// S itself, where S + ε was factored.
    refined_by: Option<SMatrix<S, M, M>>,
}

/// ε beside the largest diagonal entry of S, in units of the square root of the rounding unit.
const SHARE: f64 = 16.0;

/// Refinements: each takes the error by what S + ε adds down by ε/(σ + ε), with σ the least singular value
/// that counts.
const REFINEMENTS: u32 = 4;

impl<S: Scalar, const M: usize> Complement<S, M> {
    /// Of the matrix; nothing if an entry is not finite, or if it is 0.
    pub(super) fn of(matrix: &SMatrix<S, M, M>) -> Option<Self> {
        if let Some(factored) = NewtonMatrix::factored(matrix) {
            return Some(Self { factored, refined_by: None });
        }
        let mut largest = S::zero();
        for (k, column) in matrix.data.0.iter().enumerate() {
            largest = largest.max(column.get(k).map_or(largest, |entry| entry.abs()));
        }
        let epsilon = largest * S::EPSILON.sqrt() * S::constant(SHARE);
        let regular = matrix + SMatrix::identity() * epsilon;
        let factored = NewtonMatrix::factored(&regular)?;
        Some(Self { factored, refined_by: Some(*matrix) })
    }

    /// Whether the constraints are redundant where this was formed, or singular.
    pub(super) fn is_deficient(&self) -> bool {
        self.refined_by.is_some()
    }

    /// The solution of S x = `right`.
    pub(super) fn solve(&self, right: &SVector<S, M>) -> SVector<S, M> {
        let mut x = self.factored.solve(right);
        if let Some(matrix) = &self.refined_by {
            for _ in 0..REFINEMENTS {
                x += self.factored.solve(&(right - matrix * x));
            }
        }
        x
    }
}
