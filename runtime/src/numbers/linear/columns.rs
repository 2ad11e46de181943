//! Matrices column by column, of arrays: an index that nothing shows to be within bounds would bring a panic
//! into the step.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;

/// The matrix whose columns are those that `of` makes of the columns of `matrix`.
pub(crate) fn by_columns<S: Scalar, const R: usize, const C: usize, const K: usize>(
    matrix: &SMatrix<S, R, C>,
    of: impl Fn(&SVector<S, R>) -> SVector<S, K>,
) -> SMatrix<S, K, C> {
    let mut made: SMatrix<S, K, C> = nalgebra::zero();
    for (made, column) in made.data.0.iter_mut().zip(&matrix.data.0) {
        [*made] = of(&SVector::from(*column)).data.0;
    }
    made
}
