//! The Schur complement of the constraints.

use nalgebra::{SMatrix, SVector};

use super::independent::Independent;
use crate::numbers::linear::{FactoredDense, factored_to_half};
use crate::numbers::{Factored, Scalar};

/// The Schur complement S = G(q1) W⁻¹ G(q0)ᵀ of M constraints, made ready to solve with.
///
/// Where S has lost half of its digits, as it has where less than 10⁻⁴ is left of a gradient beside the
/// others, its triangles are formed from the gradients themselves ([`Independent`]): these lose a digit where
/// S loses two, and tell a constraint that nearly depends on others from one that is redundant.
#[derive(Clone, Copy, Debug)]
pub(in crate::step) enum Complement<S: Scalar, const M: usize> {
    Regular(FactoredDense<S, M>),
    Dependent(Independent<S, M>),
}

impl<S: Scalar, const M: usize> Complement<S, M> {
    /// Of the `matrix` S; where that is nearly singular, by its triangles. Nothing if it is singular beyond
    /// redundancy, or an entry is not finite.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(in crate::step) fn of(
        matrix: &SMatrix<S, M, M>,
        independent: impl FnOnce() -> Option<Independent<S, M>>,
    ) -> Option<Self> {
        match factored_to_half(matrix) {
            Some(factored) => Some(Self::Regular(factored)),
            None => independent().map(Self::Dependent),
        }
    }

    /// The solution of S x = `right`: of redundant constraints that of least Σ |Sₖₖ| xₖ².
    pub(in crate::step) fn solve(&self, right: &SVector<S, M>) -> SVector<S, M> {
        match self {
            Self::Regular(factored) => factored.solve(right),
            Self::Dependent(independent) => independent.solve(right),
        }
    }
}
