//! The Schur complement of the constraints.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Factored, NewtonMatrix, Scalar, nonlinear::largest};

/// The Schur complement S = G(q1) W⁻¹ G(q0)ᵀ of M constraints, made ready to solve with.
///
/// Where constraints are redundant, S is singular and the equations are consistent all the same: then
/// S + ε is factored, and solutions are refined with S, which leads to the one of least norm. Constraints are
/// scaled by their own entries for that, so that neither their units nor the masses matter: the norm is that
/// of λₖ √|Sₖₖ|.
#[derive(Clone, Copy, Debug)]
pub(super) struct Complement<S: Scalar, const M: usize> {
    factored: <SMatrix<S, M, M> as NewtonMatrix<S, M>>::Factored,
    /// S itself and the scales of the constraints, where S + ε was factored.
    refined_by: Option<(SMatrix<S, M, M>, SVector<S, M>)>,
}

/// ε beside a diagonal of 1, in units of the rounding unit to the power ⅔: below what constraints leave of
/// one another beside a light body, and so far above rounding that λ along redundant ones is good to a
/// millionth.
const SHARE: f64 = 16.0;

/// Refinements at most: each takes the error by what S + ε adds down by ε/(σ + ε), with σ the least singular
/// value that counts.
const REFINEMENTS: u32 = 32;

impl<S: Scalar, const M: usize> Complement<S, M> {
    /// Of the matrix; nothing if an entry is not finite.
    pub(super) fn of(matrix: &SMatrix<S, M, M>) -> Option<Self> {
        if let Some(factored) = NewtonMatrix::factored(matrix) {
            return Some(Self { factored, refined_by: None });
        }
        let scales = scales(matrix);
        let mut scaled = *matrix;
        for (column, of_column) in scaled.data.0.iter_mut().zip(scales.as_slice()) {
            for (entry, of_row) in column.iter_mut().zip(scales.as_slice()) {
                *entry = *entry * *of_row * *of_column;
            }
        }
        let regular = scaled + SMatrix::identity() * (S::EPSILON.cbrt().powi(2) * S::constant(SHARE));
        let factored = NewtonMatrix::factored(&regular)?;
        Some(Self { factored, refined_by: Some((scaled, scales)) })
    }

    /// Whether the constraints are redundant where this was formed, or singular.
    pub(super) fn is_deficient(&self) -> bool {
        self.refined_by.is_some()
    }

    /// The solution of S x = `right`.
    pub(super) fn solve(&self, right: &SVector<S, M>) -> SVector<S, M> {
        let Some((scaled, scales)) = &self.refined_by else { return self.factored.solve(right) };
        let right = right.component_mul(scales);
        let mut x = self.factored.solve(&right);
        let mut left = right - scaled * x;
        for _ in 0..REFINEMENTS {
            let next = x + self.factored.solve(&left);
            let next_left = right - scaled * next;
            let is_lower = largest(next_left.as_slice()) < largest(left.as_slice()) * S::constant(0.5);
            // Rounding holds it up, or it is no number.
            if !is_lower {
                break;
            }
            (x, left) = (next, next_left);
        }
        x.component_mul(scales)
    }
}

/// 1/√|Sₖₖ|, by which the diagonal becomes ±1; 1 where it is 0.
fn scales<S: Scalar, const M: usize>(matrix: &SMatrix<S, M, M>) -> SVector<S, M> {
    let mut scales: SVector<S, M> = nalgebra::zero();
    for (k, (scale, column)) in scales.as_mut_slice().iter_mut().zip(&matrix.data.0).enumerate() {
        let size = column.get(k).map_or(S::zero(), |entry| entry.abs());
        *scale = if size > S::zero() { S::one() / size.sqrt() } else { S::one() };
    }
    scales
}
