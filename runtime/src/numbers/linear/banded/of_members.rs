//! Bands of several members at once, factored before the run or solved with once: the operations of
//! each, in their order.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use super::{Banded, FactoredBand, SMALL};
use crate::numbers::linear::MatricesOfMembers;
use crate::numbers::members::each_coordinate;
use crate::numbers::{Mask, MemberVector, Members, Scalar};

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
            is_solved = is_solved & (largest * S::constant(SMALL)).less(pivot.abs());
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
