//! Matrices of several members at once, factored before the run or solved with once: the operations of each,
//! in their order.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use nalgebra::SMatrix;

use super::banded::{self, FactoredBand};
use super::dense::{self, FactoredDense};
use super::{Banded, NewtonMatrix};
use crate::numbers::members::{coordinate_by_coordinate, counted, each_coordinate};
use crate::numbers::{Mask, MemberVector, Members, Scalar};

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

    /// [`Factored::solve`](super::Factored::solve) of each.
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

/// Dense matrices of W members.
#[derive(Clone, Copy, Debug)]
pub struct DenseOfMembers<S, const N: usize, const W: usize> {
    matrix: [MemberVector<S, N, W>; N],
    rows: [MemberVector<S, N, W>; N],
    /// Which row of its matrix came to stand here, of each member.
    order: [[usize; W]; N],
    reciprocals: MemberVector<S, N, W>,
}

impl<S: Scalar, const N: usize, const W: usize> MatricesOfMembers<S, N, W> for DenseOfMembers<S, N, W> {
    type Matrix = SMatrix<S, N, N>;
    type Entries = [MemberVector<S, N, W>; N];

    fn zero() -> Self {
        let zero = [Members::splat(S::zero()); N];
        Self { matrix: [zero; N], rows: [zero; N], order: [[0; W]; N], reciprocals: zero }
    }

    fn write(&mut self, member: usize, matrix: &SMatrix<S, N, N>, factored: &FactoredDense<S, N>) {
        if member >= W {
            return;
        }
        for i in 0..N {
            self.order[i][member] = factored.order[i];
            self.reciprocals[i].0[member] = factored.reciprocals[i];
            for j in 0..N {
                self.matrix[i][j].0[member] = matrix[(i, j)];
                self.rows[i][j].0[member] = factored.rows[i][j];
            }
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn solve(&self, right: &MemberVector<S, N, W>) -> MemberVector<S, N, W> {
        let mut x = *right;
        for i in 0..N {
            for member in 0..W {
                // No row but is within the matrix; the compiler shall know it.
                x[i].0[member] = right[self.order[i][member].min(N - 1)].0[member];
            }
        }
        substituted(&self.rows, &self.reciprocals, x)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn magnitudes(&self, v: &MemberVector<S, N, W>) -> MemberVector<S, N, W> {
        Self::magnitudes_of(&self.matrix, v)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn solution(entries: &Self::Entries, right: &MemberVector<S, N, W>) -> (MemberVector<S, N, W>, Mask<W>) {
        match N {
            1 | 2 => closed_form(entries, right),
            _ => eliminate(*entries, *right),
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn magnitudes_of(entries: &Self::Entries, v: &MemberVector<S, N, W>) -> MemberVector<S, N, W> {
        let mut sums = [Members::splat(S::zero()); N];
        each_coordinate!(i => {
            for j in 0..N {
                sums[i] = sums[i] + (entries[i][j] * v[j]).abs();
            }
        });
        sums
    }
}

/// The solution with one or two coordinates in closed form, as [`dense`] has it; the mask is false where the
/// determinant is 0, not finite or lost to cancellation.
#[cfg_attr(not(debug_assertions), inline(always))]
fn closed_form<S: Scalar, const N: usize, const W: usize>(
    entries: &[MemberVector<S, N, W>; N],
    right: &MemberVector<S, N, W>,
) -> (MemberVector<S, N, W>, Mask<W>) {
    let (zero, mut x) = (Members::splat(S::zero()), *right);
    if N == 1 {
        let entry = entries[0][0];
        x[0] = right[0] / entry;
        return (x, !entry.equal(zero) & entry.is_finite());
    }
    let [a, b, c, d] = [entries[0][0], entries[0][1], entries[1][0], entries[1][1]];
    let (ad, bc) = (a * d, b * c);
    let determinant = ad - bc;
    let reciprocal = Members::splat(S::one()) / determinant;
    x[0] = (d * right[0] - b * right[1]) * reciprocal;
    x[1] = (a * right[1] - c * right[0]) * reciprocal;
    let cancelled = (ad.abs() + bc.abs()) * (S::EPSILON * S::constant(16.0)) + S::SMALLEST_NORMAL;
    (x, cancelled.less(determinant.abs()) & zero.less(reciprocal.abs()))
}

/// Elimination with the row exchanges of each member; the mask is false where a pivot is suspicious.
#[cfg_attr(not(debug_assertions), inline(always))]
fn eliminate<S: Scalar, const N: usize, const W: usize>(
    mut rows: [MemberVector<S, N, W>; N],
    mut x: MemberVector<S, N, W>,
) -> (MemberVector<S, N, W>, Mask<W>) {
    let (zero, one) = (Members::splat(S::zero()), Members::splat(S::one()));
    // As in `coordinate_by_coordinate`: N³ operations in loops.
    let order = core::hint::black_box(const { counted::<N>() });
    let mut is_solved = Mask::splat(true);
    let mut scale = [zero; N];
    for i in 0..N {
        let mut largest = zero;
        for j in 0..N {
            largest = rows[i][j].abs().larger(largest);
        }
        scale[i] = Members::select(zero.less(largest), one / largest, zero);
    }
    let mut reciprocals = scale;
    coordinate_by_coordinate!(k => {
        let below = order.get(k + 1..).unwrap_or_default();
        let mut best = rows[k][k].abs() * scale[k];
        let mut pivot = [k; W];
        coordinate_by_coordinate!(i of below => {
            let candidate = rows[i][k].abs() * scale[i];
            for member in 0..W {
                let is_better = candidate.0[member] > best.0[member];
                pivot[member] = if is_better { i } else { pivot[member] };
            }
            best = candidate.larger(best);
        });
        is_solved = is_solved & Members::splat(S::constant(dense::SUSPICIOUS)).less(best);
        coordinate_by_coordinate!(i of below => {
            let here = Mask(pivot.map(|pivot| pivot == i));
            if here.0.contains(&true) {
                let exchanged = |a, b| (Members::select(here, b, a), Members::select(here, a, b));
                coordinate_by_coordinate!(j => {
                    (rows[k][j], rows[i][j]) = exchanged(rows[k][j], rows[i][j]);
                });
                (scale[k], scale[i]) = exchanged(scale[k], scale[i]);
                (x[k], x[i]) = exchanged(x[k], x[i]);
            }
        });
        reciprocals[k] = one / rows[k][k];
        coordinate_by_coordinate!(i of below => {
            let factor = rows[i][k] * reciprocals[k];
            rows[i][k] = factor;
            coordinate_by_coordinate!(j of below => {
                rows[i][j] = rows[i][j] - factor * rows[k][j];
            });
        });
    });
    (substituted(&rows, &reciprocals, x), is_solved)
}

/// The solution with the triangles, of the `x` on the right whose rows are in their order.
#[cfg_attr(not(debug_assertions), inline(always))]
fn substituted<S: Scalar, const N: usize, const W: usize>(
    rows: &[MemberVector<S, N, W>; N],
    reciprocals: &MemberVector<S, N, W>,
    mut x: MemberVector<S, N, W>,
) -> MemberVector<S, N, W> {
    for i in 1..N {
        for k in 0..i {
            x[i] = x[i] - rows[i][k] * x[k];
        }
    }
    for i in (0..N).rev() {
        for j in i + 1..N {
            x[i] = x[i] - rows[i][j] * x[j];
        }
        x[i] = x[i] * reciprocals[i];
    }
    x
}

/// Bands of W members.
#[derive(Clone, Copy, Debug)]
pub struct BandedOfMembers<S, const N: usize, const B: usize, const W: usize> {
    matrix: [MemberVector<S, B, W>; N],
    rows: [MemberVector<S, B, W>; N],
}

impl<S: Scalar, const N: usize, const B: usize, const W: usize> MatricesOfMembers<S, N, W>
    for BandedOfMembers<S, N, B, W>
{
    type Matrix = Banded<S, N, B>;
    type Entries = [MemberVector<S, B, W>; N];

    fn zero() -> Self {
        let zero = [[Members::splat(S::zero()); B]; N];
        Self { matrix: zero, rows: zero }
    }

    fn write(&mut self, member: usize, matrix: &Banded<S, N, B>, factored: &FactoredBand<S, N, B>) {
        if member >= W {
            return;
        }
        for i in 0..N {
            for k in 0..B {
                self.matrix[i][k].0[member] = matrix.rows[i][k];
                self.rows[i][k].0[member] = factored.rows[i][k];
            }
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn solve(&self, right: &MemberVector<S, N, W>) -> MemberVector<S, N, W> {
        solved_by_band(&self.rows, right)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn magnitudes(&self, v: &MemberVector<S, N, W>) -> MemberVector<S, N, W> {
        Self::magnitudes_of(&self.matrix, v)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn solution(entries: &Self::Entries, right: &MemberVector<S, N, W>) -> (MemberVector<S, N, W>, Mask<W>) {
        let b = B / 2;
        let mut rows = *entries;
        let mut is_solved = Mask::splat(true);
        for i in 0..N {
            let mut largest = Members::splat(S::zero());
            for k in 0..B {
                largest = entries[i][k].abs().larger(largest);
            }
            for k in 0..b {
                if i + k >= b {
                    let above = i + k - b;
                    let factor = rows[i][k];
                    for l in 1..=b {
                        if k + l < B {
                            rows[i][k + l] = rows[i][k + l] - factor * rows[above][b + l];
                        }
                    }
                    rows[i][k] = factor * rows[above][b];
                }
            }
            let pivot = rows[i][b];
            is_solved = is_solved & (largest * S::constant(banded::SMALL)).less(pivot.abs());
            let reciprocal = Members::splat(S::one()) / pivot;
            for l in 1..=b {
                rows[i][b + l] = rows[i][b + l] * reciprocal;
            }
            rows[i][b] = reciprocal;
        }
        (solved_by_band(&rows, right), is_solved)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn magnitudes_of(entries: &Self::Entries, v: &MemberVector<S, N, W>) -> MemberVector<S, N, W> {
        let b = B / 2;
        let mut sums = [Members::splat(S::zero()); N];
        each_coordinate!(i => {
            for k in 0..B {
                if i + k >= b && i + k - b < N {
                    sums[i] = sums[i] + (entries[i][k] * v[i + k - b]).abs();
                }
            }
        });
        sums
    }
}

/// The solution with factored bands.
#[cfg_attr(not(debug_assertions), inline(always))]
fn solved_by_band<S: Scalar, const N: usize, const B: usize, const W: usize>(
    rows: &[MemberVector<S, B, W>; N],
    right: &MemberVector<S, N, W>,
) -> MemberVector<S, N, W> {
    let b = B / 2;
    let mut x = *right;
    if b == 0 {
        each_coordinate!(i => {
            x[i] = x[i] * rows[i][b];
        });
        return x;
    }
    for i in 0..N {
        for k in 0..b {
            if i + k >= b {
                x[i] = x[i] - rows[i][k] * x[i + k - b];
            }
        }
    }
    for i in (0..N).rev() {
        x[i] = x[i] * rows[i][b];
        for l in 1..=b {
            if i + l < N {
                x[i] = x[i] - rows[i][b + l] * x[i + l];
            }
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SVector;

    const W: usize = 8;

    /// Matrices of all sizes and shapes: diagonals that call for exchanges in some members, rows that lose
    /// all digits, rows of zeros.
    fn entry(member: usize, i: usize, j: usize) -> f64 {
        let any = ((13 * member + 5 * i + 3 * j * j + 7 * i * i * j) as f64 + 0.7).sin();
        match member {
            0 if i == j => any + 3.0,
            5 => ((i + 2 * j + i * j) as f64).sin() * if i == 0 { 1e-14 } else { 1.0 },
            6 if i == 0 => 0.0,
            7 if i == j => 1e-9 * any,
            _ => any,
        }
    }

    fn dense_agrees<const N: usize>() -> usize {
        let matrices: [SMatrix<f64, N, N>; W] =
            core::array::from_fn(|member| SMatrix::from_fn(|i, j| entry(member, i, j)));
        let entries = core::array::from_fn(|i| {
            core::array::from_fn(|j| Members(matrices.map(|matrix: SMatrix<f64, N, N>| matrix[(i, j)])))
        });
        let right: MemberVector<f64, N, W> =
            core::array::from_fn(|i| Members(core::array::from_fn(|member| entry(member, i, 17))));
        let (solutions, is_solved) = DenseOfMembers::<f64, N, W>::solution(&entries, &right);
        let magnitudes = DenseOfMembers::<f64, N, W>::magnitudes_of(&entries, &right);
        for member in 0..W {
            let right = SVector::from_fn(|i, _| right[i].0[member]);
            let alone = matrices[member].magnitudes(&right);
            assert!((0..N).all(|i| magnitudes[i].0[member].to_bits() == alone[i].to_bits()));
            if is_solved.0[member] {
                let alone = matrices[member].solve(&right).expect("it is solved in lanes");
                assert!(
                    (0..N).all(|i| solutions[i].0[member].to_bits() == alone[i].to_bits()),
                    "{N} {member}"
                );
            }
        }
        is_solved.0.iter().filter(|is_solved| **is_solved).count()
    }

    fn band_agrees<const N: usize, const B: usize>() -> usize {
        let at = |member: usize, i: usize, k: usize| {
            let is_within = i + k >= B / 2 && i + k - B / 2 < N;
            if is_within { entry(member, i, i + k) + if k == B / 2 { 2.0 } else { 0.0 } } else { 0.0 }
        };
        let matrices: [Banded<f64, N, B>; W] = core::array::from_fn(|member| Banded {
            rows: core::array::from_fn(|i| core::array::from_fn(|k| at(member, i, k))),
        });
        let entries = core::array::from_fn(|i| {
            core::array::from_fn(|k| Members(matrices.map(|matrix: Banded<f64, N, B>| matrix.rows[i][k])))
        });
        let right: MemberVector<f64, N, W> =
            core::array::from_fn(|i| Members(core::array::from_fn(|member| entry(member, i, 17))));
        let (solutions, is_solved) = BandedOfMembers::<f64, N, B, W>::solution(&entries, &right);
        for member in 0..W {
            let right = SVector::from_fn(|i, _| right[i].0[member]);
            if is_solved.0[member] {
                let alone = matrices[member].solve(&right).expect("it is solved in lanes");
                assert!(
                    (0..N).all(|i| solutions[i].0[member].to_bits() == alone[i].to_bits()),
                    "{N} {member}"
                );
            }
        }
        is_solved.0.iter().filter(|is_solved| **is_solved).count()
    }

    #[test]
    fn each_member_gets_the_solution_that_its_matrix_gives_alone() {
        let solved = [dense_agrees::<1>(), dense_agrees::<2>(), dense_agrees::<3>(), dense_agrees::<7>()];
        assert!(solved.iter().all(|&solved| (4..8).contains(&solved)), "{solved:?}");
        let solved = [band_agrees::<5, 1>(), band_agrees::<6, 3>(), band_agrees::<18, 5>()];
        assert!(solved.iter().all(|&solved| (2..=8).contains(&solved)), "{solved:?}");
    }
}
