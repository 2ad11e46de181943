//! Factored matrices of several members at once: the operations of each, in their order.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use nalgebra::SMatrix;

use super::banded::FactoredBand;
use super::dense::FactoredDense;
use super::{Banded, NewtonMatrix};
use crate::numbers::members::each_coordinate;
use crate::numbers::{MemberVector, Members, Scalar};

/// The matrices of W members, made ready to solve with.
pub trait MatricesOfMembers<S: Scalar, const N: usize, const W: usize>: Copy + core::fmt::Debug {
    /// That of one member.
    type Matrix: NewtonMatrix<S, N>;

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
}

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

    #[inline(always)]
    fn solve(&self, right: &MemberVector<S, N, W>) -> MemberVector<S, N, W> {
        let mut x = *right;
        for i in 0..N {
            for member in 0..W {
                // No row but is within the matrix; the compiler shall know it.
                x[i].0[member] = right[self.order[i][member].min(N - 1)].0[member];
            }
        }
        for i in 1..N {
            for k in 0..i {
                x[i] = x[i] - self.rows[i][k] * x[k];
            }
        }
        for i in (0..N).rev() {
            for j in i + 1..N {
                x[i] = x[i] - self.rows[i][j] * x[j];
            }
            x[i] = x[i] * self.reciprocals[i];
        }
        x
    }

    #[inline(always)]
    fn magnitudes(&self, v: &MemberVector<S, N, W>) -> MemberVector<S, N, W> {
        let mut sums = [Members::splat(S::zero()); N];
        each_coordinate!(i => {
            for j in 0..N {
                sums[i] = sums[i] + (self.matrix[i][j] * v[j]).abs();
            }
        });
        sums
    }
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

    #[inline(always)]
    fn solve(&self, right: &MemberVector<S, N, W>) -> MemberVector<S, N, W> {
        let b = B / 2;
        let mut x = *right;
        if b == 0 {
            each_coordinate!(i => {
                x[i] = x[i] * self.rows[i][b];
            });
            return x;
        }
        for i in 0..N {
            for k in 0..b {
                if i + k >= b {
                    x[i] = x[i] - self.rows[i][k] * x[i + k - b];
                }
            }
        }
        for i in (0..N).rev() {
            x[i] = x[i] * self.rows[i][b];
            for l in 1..=b {
                if i + l < N {
                    x[i] = x[i] - self.rows[i][b + l] * x[i + l];
                }
            }
        }
        x
    }

    #[inline(always)]
    fn magnitudes(&self, v: &MemberVector<S, N, W>) -> MemberVector<S, N, W> {
        let b = B / 2;
        let mut sums = [Members::splat(S::zero()); N];
        each_coordinate!(i => {
            for k in 0..B {
                if i + k >= b && i + k - b < N {
                    sums[i] = sums[i] + (self.matrix[i][k] * v[i + k - b]).abs();
                }
            }
        });
        sums
    }
}
