//! Linear systems of the size of the configuration space: elimination with scaled partial pivoting.
//!
//! Own code because a step must not panic, must not allocate, and must tell a singular matrix from a badly scaled one;
//! nalgebra's factorisations do none of the three for every N.

use core::array;

use nalgebra::{SMatrix, SVector};

use crate::Scalar;

/// A matrix that has no solution to double precision: the column whose pivot is lost to rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Singular {
    pub(crate) column: usize,
}

/// P A = L U, with the row order of P.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factors<S, const N: usize> {
    rows: [[S; N]; N],
    order: [usize; N],
}

/// A pivot this much smaller than its column is looked at more closely.
const SUSPICIOUS: f64 = 1e-6;

#[expect(clippy::neg_cmp_op_on_partial_ord, reason = "a NaN pivot must fail the comparison")]
#[expect(clippy::needless_range_loop, reason = "rows k and i of one array are used together")]
impl<S: Scalar, const N: usize> Factors<S, N> {
    #[inline]
    pub(crate) fn of(matrix: &SMatrix<S, N, N>) -> Result<Self, Singular> {
        let mut rows: [[S; N]; N] = array::from_fn(|i| array::from_fn(|j| matrix[(i, j)]));
        let mut order: [usize; N] = array::from_fn(|i| i);
        let mut scale: [S; N] = array::from_fn(|i| inverse_magnitude(&rows[i]));
        let mut suspicious = false;

        for k in 0..N {
            let mut pivot = k;
            let mut best = rows[k][k].abs() * scale[k];
            for i in k + 1..N {
                let candidate = rows[i][k].abs() * scale[i];
                if candidate > best {
                    (pivot, best) = (i, candidate);
                }
            }
            // `best` is relative to the row; a value that is not above the threshold also covers NaN.
            if !(best > S::constant(SUSPICIOUS)) {
                suspicious = true;
                if !(best > S::zero()) {
                    return Err(Singular { column: k });
                }
            }
            if pivot != k {
                rows.swap(k, pivot);
                order.swap(k, pivot);
                scale.swap(k, pivot);
            }
            let reciprocal = S::one() / rows[k][k];
            for i in k + 1..N {
                let factor = rows[i][k] * reciprocal;
                rows[i][k] = factor;
                for j in k + 1..N {
                    let upper = rows[k][j];
                    rows[i][j] -= factor * upper;
                }
            }
        }

        let factors = Self { rows, order };
        if suspicious {
            factors.check_cancellation(matrix)?;
        }
        Ok(factors)
    }

    /// A pivot is lost if it is below the rounding error of the sum that formed it.
    ///
    /// The test compares each uᵢᵢ with |aᵢᵢ| + Σ|lᵢₖ||uₖᵢ|: scaling rows or columns changes neither verdict.
    #[cold]
    fn check_cancellation(&self, matrix: &SMatrix<S, N, N>) -> Result<(), Singular> {
        let threshold = S::EPSILON * S::constant(8.0 * N as f64);
        for k in 0..N {
            let mut magnitude = matrix[(self.order[k], k)].abs();
            for j in 0..k {
                magnitude += (self.rows[k][j] * self.rows[j][k]).abs();
            }
            if !(self.rows[k][k].abs() > threshold * magnitude) {
                return Err(Singular { column: k });
            }
        }
        Ok(())
    }

    /// The solution x of A x = `right`.
    #[inline]
    pub(crate) fn solve(&self, right: &SVector<S, N>) -> SVector<S, N> {
        let mut x: SVector<S, N> = SVector::from_fn(|i, _| right[self.order[i]]);
        for i in 0..N {
            for j in 0..i {
                let known = x[j];
                x[i] -= self.rows[i][j] * known;
            }
        }
        for i in (0..N).rev() {
            for j in i + 1..N {
                let known = x[j];
                x[i] -= self.rows[i][j] * known;
            }
            x[i] /= self.rows[i][i];
        }
        x
    }
}

#[inline]
fn inverse_magnitude<S: Scalar, const N: usize>(row: &[S; N]) -> S {
    let largest = row.iter().fold(S::zero(), |largest, entry| largest.max(entry.abs()));
    if largest > S::zero() { S::one() / largest } else { S::zero() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{matrix, vector};

    #[test]
    fn solves_a_system_that_needs_pivoting() {
        let a = matrix![0.0, 2.0, 1.0; 1.0, 0.0, 3.0; 4.0, 1.0, 0.0];
        let x = vector![1.0, -2.0, 3.0];
        let solution = Factors::of(&a).unwrap().solve(&(a * x));
        assert!((solution - x).amax() < 1e-15);
    }

    #[test]
    fn bad_scaling_is_not_singularity() {
        // D A D with D = diag(1e-12, 1e12) and A = [[1, ½], [½, 1]]: regular, though its entries span 48 decades.
        let a = matrix![1e-24, 0.5; 0.5, 1e24];
        let solution = Factors::of(&a).unwrap().solve(&vector![1e-12, 1e12]);
        let expected = vector![1e12 * 2.0 / 3.0, 1e-12 * 2.0 / 3.0];
        for i in 0..2 {
            assert!(f64::abs(solution[i] / expected[i] - 1.0) < 1e-15, "{solution}");
        }
    }

    #[test]
    fn dependent_rows_are_singular() {
        let a = matrix![1.0, 2.0, 3.0; 4.0, 5.0, 6.0; 7.0, 8.0, 9.0];
        assert_eq!(Factors::of(&a).unwrap_err(), Singular { column: 2 });
        assert_eq!(Factors::of(&matrix![0.0]).unwrap_err(), Singular { column: 0 });
        assert_eq!(Factors::of(&matrix![1.0, 1.0; f64::NAN, 1.0]).unwrap_err().column, 1);
    }

    #[test]
    fn a_small_determinant_alone_is_regular() {
        // Positive control of the cancellation test: ill-conditioned, but its pivot carries digits.
        let a = matrix![1.0, 1.0; 1.0, 1.0 + 1e-9];
        assert!(Factors::of(&a).is_ok());
    }
}
