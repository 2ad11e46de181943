//! Banded systems: elimination along the band, checked pivot by pivot.

use nalgebra::SVector;

use super::{Factored, NewtonMatrix, dense};
use crate::numbers::{Scalar, Singular};
use of_members::BandedOfMembers;

mod of_members;

/// A matrix whose entries lie within B of the diagonal, W = 2B + 1: Newton matrices of chains, and diagonal
/// ones (W = 1).
///
/// `rows[i][k]` is the entry at row i and column i + k − B; what falls outside the matrix is 0.
///
/// ```
/// use dalembert::nalgebra::vector;
/// use dalembert::step::{Banded, NewtonMatrix};
///
/// let chain = Banded { rows: [[0.0, 1.0, -1.0], [-1.0, 2.0, -1.0], [-1.0, 2.0, 0.0]] };
/// assert_eq!(chain.solve(&vector![0.0, 0.0, 1.0]), Ok(vector![1.0, 1.0, 1.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Banded<S, const N: usize, const W: usize> {
    /// The band, row by row.
    pub rows: [[S; W]; N],
}

/// A pivot smaller than this share of its row's largest entry calls for row exchanges, which a band has no
/// room for.
const SMALL: f64 = 1e-3;

impl<S: Scalar, const N: usize, const W: usize> Banded<S, N, W> {
    /// Entries to either side of the diagonal.
    const B: usize = {
        assert!(W % 2 == 1, "a band has as many diagonals above as below");
        W / 2
    };

    /// Elimination without row exchanges.
    #[inline]
    fn eliminate(&self, right: &SVector<S, N>) -> Option<SVector<S, N>> {
        Some(self.factored()?.solve(right))
    }
}

/// A band as the product L D U of triangles with diagonal 1 and the pivots, whose reciprocals lie on the
/// diagonal: in solving, nothing waits for a product with one.
#[derive(Clone, Copy, Debug)]
pub struct FactoredBand<S, const N: usize, const W: usize> {
    rows: [[S; W]; N],
}

impl<S: Scalar, const N: usize, const W: usize> Factored<S, N> for FactoredBand<S, N, W> {
    #[inline]
    fn solve(&self, right: &SVector<S, N>) -> SVector<S, N> {
        let b = W / 2;
        let mut x: [S; N] = (*right).into();
        for i in 0..N {
            let row = &self.rows[i];
            let mut value = x[i];
            for k in 0..b {
                if i + k >= b {
                    value -= row[k] * x[i + k - b];
                }
            }
            x[i] = value;
        }
        for i in (0..N).rev() {
            let row = &self.rows[i];
            let mut value = x[i] * row[b];
            for l in 1..=b {
                if i + l < N {
                    value -= row[b + l] * x[i + l];
                }
            }
            x[i] = value;
        }
        x.into()
    }
}

impl<S: Scalar, const N: usize, const W: usize> NewtonMatrix<S, N> for Banded<S, N, W> {
    type Factored = FactoredBand<S, N, W>;
    type OfMembers<const M: usize> = BandedOfMembers<S, N, W, M>;

    /// Factors without row exchanges; `None` if a pivot is small beside its row, which calls for them.
    #[inline]
    #[expect(clippy::neg_cmp_op_on_partial_ord, reason = "a NaN pivot must fail the comparison")]
    fn factored(&self) -> Option<FactoredBand<S, N, W>> {
        let b = Self::B;
        let mut rows = self.rows;
        for i in 0..N {
            let mut largest = S::zero();
            for k in 0..W {
                largest = largest.max(self.rows[i][k].abs());
            }
            // Rows above hold their unit-diagonal form: entries right of the diagonal, divided by the pivot.
            for k in 0..b {
                if i + k >= b {
                    let above = i + k - b;
                    let factor = rows[i][k];
                    for l in 1..=b {
                        // Column above + l, in this row at k + l.
                        if k + l < W {
                            let entry = rows[above][b + l];
                            rows[i][k + l] -= factor * entry;
                        }
                    }
                    rows[i][k] = factor * rows[above][b];
                }
            }
            let pivot = rows[i][b];
            if !(pivot.abs() > largest * S::constant(SMALL)) {
                return None;
            }
            let reciprocal = S::one() / pivot;
            for l in 1..=b {
                rows[i][b + l] *= reciprocal;
            }
            rows[i][b] = reciprocal;
        }
        Some(FactoredBand { rows })
    }

    #[inline]
    fn zero() -> Self {
        Self { rows: [[S::zero(); W]; N] }
    }

    #[inline]
    fn entry(&self, row: usize, column: usize) -> S {
        match (column + Self::B).checked_sub(row) {
            Some(k) if column < N => {
                self.rows.get(row).and_then(|row| row.get(k)).copied().unwrap_or_else(S::zero)
            }
            _ => S::zero(),
        }
    }

    #[inline]
    fn solve(&self, right: &SVector<S, N>) -> Result<SVector<S, N>, Singular> {
        match self.eliminate(right) {
            Some(x) => Ok(x),
            None => pivoted(self, right),
        }
    }

    #[inline]
    fn magnitudes(&self, v: &SVector<S, N>) -> SVector<S, N> {
        let b = Self::B;
        SVector::from_fn(|i, _| {
            let mut sum = S::zero();
            for k in 0..W {
                if i + k >= b && i + k - b < N {
                    sum += (self.rows[i][k] * v[i + k - b]).abs();
                }
            }
            sum
        })
    }

    #[inline]
    fn plus(&self, other: &Self, factor: S) -> Self {
        let mut sum = *self;
        for (row, added) in sum.rows.iter_mut().zip(&other.rows) {
            for (entry, added) in row.iter_mut().zip(added) {
                *entry += *added * factor;
            }
        }
        sum
    }

    #[cold]
    fn hold(&mut self, held: &[S]) {
        let is_held = |i: usize| held.get(i).is_some_and(|held| *held != S::zero());
        for (i, row) in self.rows.iter_mut().enumerate() {
            for (k, entry) in row.iter_mut().enumerate() {
                if is_held(i) || (i + k).checked_sub(Self::B).is_some_and(is_held) {
                    *entry = if k == Self::B { S::one() } else { S::zero() };
                }
            }
        }
    }

    fn row_is_finite(&self, row: usize) -> bool {
        self.rows.get(row).is_none_or(|row| row.iter().all(|entry| entry.is_finite()))
    }
}

/// Solves with row exchanges, in dense form: where a pivot of the band is small beside its row, and to name a
/// singular column.
#[cold]
fn pivoted<S: Scalar, const N: usize, const W: usize>(
    matrix: &Banded<S, N, W>,
    right: &SVector<S, N>,
) -> Result<SVector<S, N>, Singular> {
    dense::eliminate(&matrix.dense(), right)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::vector;

    /// A tridiagonal and a pentadiagonal matrix that need no exchanges, with an unsymmetric band.
    fn matrices() -> (Banded<f64, 5, 3>, Banded<f64, 5, 5>) {
        let entry = |i: usize, k: usize| ((3 * i + 7 * k) as f64).sin();
        let inside = |i: usize, k: usize, b: usize| i + k >= b && i + k - b < 5;
        let tri = core::array::from_fn(|i| {
            core::array::from_fn(|k| {
                if k == 1 {
                    3.0
                } else if inside(i, k, 1) {
                    entry(i, k)
                } else {
                    0.0
                }
            })
        });
        let penta = core::array::from_fn(|i| {
            core::array::from_fn(|k| {
                if k == 2 {
                    4.0
                } else if inside(i, k, 2) {
                    entry(i, k)
                } else {
                    0.0
                }
            })
        });
        (Banded { rows: tri }, Banded { rows: penta })
    }

    #[test]
    fn the_band_solves_as_the_dense_matrix_does() {
        let right = vector![1.0, -2.0, 0.5, 3.0, -1.0];
        let (tri, penta) = matrices();
        for (banded, dense) in
            [(tri.eliminate(&right), tri.dense()), (penta.eliminate(&right), penta.dense())]
        {
            let x = banded.expect("the diagonal dominates");
            assert!((dense * x - right).amax() < 1e-14);
        }
        assert_eq!(tri.magnitudes(&right), tri.dense().magnitudes(&right));
        assert_eq!(penta.magnitudes(&right), penta.dense().magnitudes(&right));
    }

    #[test]
    fn a_diagonal_is_a_band_of_one() {
        let diagonal = Banded { rows: [[2.0], [1e-200], [-4.0]] };
        assert_eq!(diagonal.solve(&vector![1.0, 1e-200, 1.0]), Ok(vector![0.5, 1.0, -0.25]));
    }

    #[test]
    fn small_pivots_are_exchanged_and_singular_ones_named() {
        // [[0, 1], [1, 0]] has no elimination without exchanges.
        let swap = Banded { rows: [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]] };
        assert_eq!(swap.eliminate(&vector![2.0, 3.0]), None);
        assert_eq!(swap.solve(&vector![2.0, 3.0]), Ok(vector![3.0, 2.0]));
        let singular = Banded { rows: [[0.0, 1.0, 2.0], [2.0, 4.0, 0.0]] };
        assert_eq!(singular.solve(&vector![1.0, 1.0]), Err(Singular { column: 1 }));
        let lost = Banded { rows: [[0.0, f64::NAN, 2.0], [2.0, 4.0, 0.0]] };
        assert!(lost.solve(&vector![1.0, 1.0]).is_err() && !lost.row_is_finite(0) && lost.row_is_finite(1));
    }

    #[test]
    fn units_of_rows_do_not_matter() {
        let (mut matrix, _) = matrices();
        let right = vector![1.0, -2.0, 0.5, 3.0, -1.0];
        let x = matrix.solve(&right).unwrap();
        let mut scaled = right;
        for (i, factor) in [1e-12, 1.0, 1e12, 1e-6, 1e6].into_iter().enumerate() {
            matrix.rows[i].iter_mut().for_each(|entry| *entry *= factor);
            scaled[i] *= factor;
        }
        let y = matrix.eliminate(&scaled).expect("scaling rows changes no verdict");
        assert!((x - y).amax() < 1e-13);
    }

    #[test]
    fn coordinates_are_held_in_the_band_as_in_the_dense_matrix() {
        let (tri, penta) = matrices();
        for held in [[0.0; 5], [0.0, 1e-300, 0.0, 0.0, 0.0], [2.0, 0.0, 0.0, -1.0, 0.5], [1.0; 5]] {
            let (mut a, mut b) = (tri, penta);
            let (mut dense_a, mut dense_b) = (a.dense(), b.dense());
            a.hold(&held);
            b.hold(&held);
            dense_a.hold(&held);
            dense_b.hold(&held);
            assert_eq!((a.dense(), b.dense()), (dense_a, dense_b));
            for i in (0..5).filter(|i| held[*i] != 0.0) {
                assert!(
                    (0..5)
                        .all(|j| a.entry(i, j) == f64::from(u8::from(i == j))
                            && a.entry(j, i) == a.entry(i, j))
                );
            }
        }
    }
}
