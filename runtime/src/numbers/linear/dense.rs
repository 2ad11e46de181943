//! Dense systems: closed forms to N = 2, then elimination with scaled partial pivoting.

use nalgebra::{SMatrix, SVector};

use super::{Factored, NewtonMatrix};
use crate::numbers::{Scalar, Singular};
use of_members::DenseOfMembers;

mod of_members;

impl<S: Scalar, const N: usize> NewtonMatrix<S, N> for SMatrix<S, N, N> {
    type Factored = FactoredDense<S, N>;
    type OfMembers<const W: usize> = DenseOfMembers<S, N, W>;

    #[inline]
    fn factored(&self) -> Option<FactoredDense<S, N>> {
        factored(self).ok()
    }

    #[inline]
    fn zero() -> Self {
        nalgebra::zero()
    }

    #[inline]
    fn entry(&self, row: usize, column: usize) -> S {
        self.get((row, column)).copied().unwrap_or_else(S::zero)
    }

    #[inline]
    fn solve(&self, right: &SVector<S, N>) -> Result<SVector<S, N>, Singular> {
        match closed_form(self, right) {
            Some(x) => Ok(x),
            None => eliminate(self, right),
        }
    }

    #[inline]
    fn magnitudes(&self, v: &SVector<S, N>) -> SVector<S, N> {
        let mut sums: SVector<S, N> = nalgebra::zero();
        // Column by column, as the entries lie.
        for j in 0..N {
            for i in 0..N {
                sums[i] += (self[(i, j)] * v[j]).abs();
            }
        }
        sums
    }

    #[inline]
    fn plus(&self, other: &Self, factor: S) -> Self {
        self + other * factor
    }

    #[cold]
    fn hold(&mut self, held: &[S]) {
        let is_held = |i: usize| held.get(i).is_some_and(|held| *held != S::zero());
        for (j, column) in self.data.0.iter_mut().enumerate() {
            for (i, entry) in column.iter_mut().enumerate() {
                if is_held(i) || is_held(j) {
                    *entry = if i == j { S::one() } else { S::zero() };
                }
            }
        }
    }
}

/// One or two coordinates; nothing if N > 2, or if the determinant cancels.
///
/// |ad − bc| is held against |ad| + |bc|: scaling rows or columns changes neither verdict.
#[inline]
fn closed_form<S: Scalar, const N: usize>(
    matrix: &SMatrix<S, N, N>,
    right: &SVector<S, N>,
) -> Option<SVector<S, N>> {
    let mut x = *right;
    match N {
        1 => {
            x[0] = right[0] / matrix[0];
            (matrix[0] != S::zero() && matrix[0].is_finite()).then_some(x)
        }
        2 => {
            let (a, c, b, d) = (matrix[0], matrix[1], matrix[2], matrix[3]);
            let (ad, bc) = (a * d, b * c);
            let determinant = ad - bc;
            let reciprocal = S::one() / determinant;
            x[0] = (d * right[0] - b * right[1]) * reciprocal;
            x[1] = (a * right[1] - c * right[0]) * reciprocal;
            // A determinant below the normal numbers has an infinite reciprocal.
            let cancelled = (ad.abs() + bc.abs()) * (S::EPSILON * S::constant(16.0)) + S::SMALLEST_NORMAL;
            (determinant.abs() > cancelled && reciprocal.abs() > S::zero()).then_some(x)
        }
        _ => None,
    }
}

/// A pivot this much smaller than its row is looked at more closely.
const SUSPICIOUS: f64 = 1e-6;

/// Elimination with row exchanges; pivots are chosen relative to their rows.
#[inline]
pub(super) fn eliminate<S: Scalar, const N: usize>(
    matrix: &SMatrix<S, N, N>,
    right: &SVector<S, N>,
) -> Result<SVector<S, N>, Singular> {
    Ok(factored(matrix)?.solve(right))
}

/// A matrix as the product of a lower triangle with diagonal 1 and an upper one, with its rows exchanged.
#[derive(Clone, Copy, Debug)]
pub struct FactoredDense<S, const N: usize> {
    rows: [[S; N]; N],
    /// The row of the matrix that came to stand here.
    order: [usize; N],
    /// The reciprocals of the pivots.
    reciprocals: [S; N],
}

impl<S: Scalar, const N: usize> Factored<S, N> for FactoredDense<S, N> {
    #[inline]
    fn solve(&self, right: &SVector<S, N>) -> SVector<S, N> {
        // An index that nothing shows to be within bounds would bring a panic into the step.
        let mut x: SVector<S, N> = nalgebra::zero();
        for i in 0..N {
            if let Some(&entry) = right.as_slice().get(self.order[i]) {
                x[i] = entry;
            }
        }
        for i in 1..N {
            for k in 0..i {
                let known = x[k];
                x[i] -= self.rows[i][k] * known;
            }
        }
        for i in (0..N).rev() {
            for j in i + 1..N {
                let known = x[j];
                x[i] -= self.rows[i][j] * known;
            }
            x[i] *= self.reciprocals[i];
        }
        x
    }

    /// Row by row: K sums side by side, where those of one column wait for each other.
    #[expect(clippy::needless_range_loop, reason = "rows i and k of one array are used together")]
    fn solve_columns<const K: usize>(&self, right: &SMatrix<S, N, K>) -> SMatrix<S, N, K> {
        let mut x = [[S::zero(); K]; N];
        for i in 0..N {
            for j in 0..K {
                if let Some(&entry) = right.data.0[j].get(self.order[i]) {
                    x[i][j] = entry;
                }
            }
        }
        for i in 1..N {
            for k in 0..i {
                let (factor, known) = (self.rows[i][k], x[k]);
                for j in 0..K {
                    x[i][j] -= factor * known[j];
                }
            }
        }
        for i in (0..N).rev() {
            for k in i + 1..N {
                let (factor, known) = (self.rows[i][k], x[k]);
                for j in 0..K {
                    x[i][j] -= factor * known[j];
                }
            }
            for j in 0..K {
                x[i][j] *= self.reciprocals[i];
            }
        }
        let mut solution: SMatrix<S, N, K> = nalgebra::zero();
        for i in 0..N {
            for j in 0..K {
                solution.data.0[j][i] = x[i][j];
            }
        }
        solution
    }
}

#[inline]
pub(super) fn factored<S: Scalar, const N: usize>(
    matrix: &SMatrix<S, N, N>,
) -> Result<FactoredDense<S, N>, Singular> {
    factored_with(matrix, S::constant(SUSPICIOUS), S::EPSILON * S::constant(8.0 * N as f64))
}

/// The matrix made ready; nothing where rounding has taken half of the digits of a pivot, so that to refine a
/// solution once does not give all of them.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn factored_to_half<S: Scalar, const N: usize>(
    matrix: &SMatrix<S, N, N>,
) -> Option<FactoredDense<S, N>> {
    let half = S::EPSILON.sqrt();
    factored_with(matrix, half.max(S::constant(SUSPICIOUS)), half).ok()
}

/// The factors, if of each pivot that is `suspicious` beside its row rounding has left more than the share
/// `lost`.
#[expect(clippy::neg_cmp_op_on_partial_ord, reason = "a NaN pivot must fail the comparison")]
#[expect(clippy::needless_range_loop, reason = "rows k and i of one array are used together")]
#[cfg_attr(not(debug_assertions), inline(always))]
fn factored_with<S: Scalar, const N: usize>(
    matrix: &SMatrix<S, N, N>,
    suspicious: S,
    lost: S,
) -> Result<FactoredDense<S, N>, Singular> {
    let (mut rows, mut order, mut scale) = ([[S::zero(); N]; N], [0; N], [S::zero(); N]);
    // Of arrays: an index into the matrix that is not shown to be within bounds would bring a panic into the
    // step.
    for j in 0..N {
        for i in 0..N {
            rows[i][j] = matrix.data.0[j][i];
        }
    }
    for i in 0..N {
        order[i] = i;
        scale[i] = inverse_magnitude(&rows[i]);
    }
    let mut reciprocals = [S::zero(); N];
    let mut is_suspicious = false;

    for k in 0..N {
        let mut pivot = k;
        let mut best = rows[k][k].abs() * scale[k];
        for i in k + 1..N {
            let candidate = rows[i][k].abs() * scale[i];
            if candidate > best {
                (pivot, best) = (i, candidate);
            }
        }
        if !(best > suspicious) {
            is_suspicious = true;
            if !(best > S::zero()) {
                return Err(Singular { column: k });
            }
        }
        if pivot != k {
            // Known to the compiler to be a row, for the swaps to have no panicking branch.
            let pivot = pivot.min(N - 1);
            rows.swap(k, pivot);
            order.swap(k, pivot);
            scale.swap(k, pivot);
        }
        let reciprocal = S::one() / rows[k][k];
        reciprocals[k] = reciprocal;
        for i in k + 1..N {
            let factor = rows[i][k] * reciprocal;
            rows[i][k] = factor;
            for j in k + 1..N {
                let upper = rows[k][j];
                rows[i][j] -= factor * upper;
            }
        }
    }
    if is_suspicious {
        check_cancellation(matrix, &rows, &order, lost)?;
    }
    Ok(FactoredDense { rows, order, reciprocals })
}

/// A pivot is lost if it is below this share of the terms of the sum that formed it, of which rounding takes
/// ε.
///
/// The test compares each uᵢᵢ with |aᵢᵢ| + Σ|lᵢₖ||uₖᵢ|: scaling rows or columns changes neither verdict.
#[cold]
#[expect(clippy::neg_cmp_op_on_partial_ord, reason = "a NaN pivot must fail the comparison")]
#[expect(clippy::needless_range_loop, reason = "rows k and j of one array are used together")]
fn check_cancellation<S: Scalar, const N: usize>(
    matrix: &SMatrix<S, N, N>,
    rows: &[[S; N]; N],
    order: &[usize; N],
    lost: S,
) -> Result<(), Singular> {
    for k in 0..N {
        let mut magnitude = matrix[(order[k].min(N - 1), k)].abs();
        for j in 0..k {
            magnitude += (rows[k][j] * rows[j][k]).abs();
        }
        if !(rows[k][k].abs() > lost * magnitude) {
            return Err(Singular { column: k });
        }
    }
    Ok(())
}

#[inline]
fn inverse_magnitude<S: Scalar, const N: usize>(row: &[S; N]) -> S {
    let mut largest = S::zero();
    for entry in row {
        largest = largest.max(entry.abs());
    }
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
        let solution = a.solve(&(a * x)).unwrap();
        assert!((solution - x).amax() < 1e-15);
    }

    #[test]
    fn columns_side_by_side_have_the_bits_of_each_alone() {
        let entry = |i: usize, j: usize| ((7 * i + 3 * j + i * j) as f64).sin();
        let factored = SMatrix::<f64, 6, 6>::from_fn(entry).factored().unwrap();
        let right = SMatrix::<f64, 6, 4>::from_fn(|i, j| entry(j, i + 1));
        let together = factored.solve_columns(&right);
        for j in 0..4 {
            assert_eq!(together.column(j), factored.solve(&right.column(j).into_owned()));
        }
    }

    #[test]
    fn bad_scaling_is_not_singularity() {
        // D A D with D = diag(1e-12, 1e12) and A = [[1, ½], [½, 1]]: regular, though its entries span 48
        // decades.
        let a = matrix![1e-24, 0.5; 0.5, 1e24];
        let solution = a.solve(&vector![1e-12, 1e12]).unwrap();
        let expected: SVector<f64, 2> = vector![1e12 * 2.0 / 3.0, 1e-12 * 2.0 / 3.0];
        for i in 0..2 {
            assert!(f64::abs(solution[i] / expected[i] - 1.0) < 1e-15, "{solution}");
        }
    }

    #[test]
    fn dependent_rows_are_singular() {
        let a = matrix![1.0, 2.0, 3.0; 4.0, 5.0, 6.0; 7.0, 8.0, 9.0];
        assert_eq!(a.solve(&vector![1.0, 1.0, 1.0]).unwrap_err(), Singular { column: 2 });
        assert_eq!(matrix![0.0].solve(&vector![1.0]).unwrap_err(), Singular { column: 0 });
        assert!(matrix![1.0, 1.0; f64::NAN, 1.0].solve(&vector![1.0, 1.0]).is_err());
        assert!(matrix![1.0, 2.0; 0.5, 1.0].solve(&vector![1.0, 1.0]).is_err());
    }

    #[test]
    fn a_small_determinant_alone_is_regular() {
        // Positive control of the cancellation test: ill-conditioned, but its pivot carries digits.
        let a = matrix![1.0, 1.0; 1.0, 1.0 + 1e-9];
        assert!(a.solve(&vector![1.0, 1.0]).is_ok());
    }
}
