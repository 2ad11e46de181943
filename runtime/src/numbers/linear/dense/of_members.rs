//! Dense matrices of several members at once, factored before the run or solved with once: the operations of
//! each, in their order.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use nalgebra::SMatrix;

use super::{FactoredDense, SUSPICIOUS};
use crate::numbers::linear::MatricesOfMembers;
use crate::numbers::members::{coordinate_by_coordinate, counted, each_coordinate};
use crate::numbers::{Mask, MemberVector, Members, Scalar};

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

/// The solution with one or two coordinates in closed form, as [`super`] has it; the mask is false where the
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
        is_solved = is_solved & Members::splat(S::constant(SUSPICIOUS)).less(best);
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
