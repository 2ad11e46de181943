//! The stages' equations linearised, and elimination for all stages together.
//!
//! With M, B the derivatives of ∂L/∂v by v and by q, and K, C those of G by q and by v, at each stage, the residual
//! r_i = ∂L/∂v(Q_i, V_i) − P_i has
//!
//! ```text
//! ∂r_i/∂V_j = δ_ij M_i + h a_ij (B_i − C_j) − h² Σ_k a_ik K_k a_kj
//! ```

use core::array;

use nalgebra::{SMatrix, SVector};

use super::problem::Problem;
use crate::lanes::{LaneVector, lane};
use crate::{ForcedLagrangian, Scalar, Singular};

/// A vector for each stage.
pub(super) type StageVector<T, const N: usize, const S: usize> = [SVector<T, N>; S];

/// K vectors for each stage, as columns.
pub(super) type StageColumns<T, const N: usize, const S: usize, const K: usize> = [SMatrix<T, N, K>; S];

/// L and the force at one stage.
#[derive(Clone, Copy)]
pub(super) struct Local<T, const N: usize> {
    /// L.
    pub(super) lagrangian: T,
    /// ∂L/∂q.
    pub(super) slope: SVector<T, N>,
    /// ∂L/∂v.
    pub(super) momentum: SVector<T, N>,
    /// f_L.
    pub(super) force: SVector<T, N>,
    /// M = ∂²L/∂v².
    pub(super) mass: SMatrix<T, N, N>,
    /// B = ∂²L/∂v∂q.
    pub(super) momentum_by_q: SMatrix<T, N, N>,
    /// K = ∂G/∂q.
    pub(super) rate_by_q: SMatrix<T, N, N>,
    /// C = ∂G/∂v.
    pub(super) rate_by_v: SMatrix<T, N, N>,
}

impl<T: Scalar, const N: usize> Local<T, N> {
    pub(super) fn new<L: ForcedLagrangian<N, Scalar = T>>(
        system: &L,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
    ) -> Self {
        let l = system.lagrangian_derivatives(q, v);
        let mut local = Self {
            lagrangian: l.value,
            slope: l.d1,
            momentum: l.d2,
            force: nalgebra::zero(),
            mass: l.d22,
            momentum_by_q: l.d12.transpose(),
            rate_by_q: l.d11,
            rate_by_v: l.d12,
        };
        if L::IS_FORCED {
            let f = system.acting_force_derivatives(q, v);
            local.force = f.value;
            local.rate_by_q += f.d1;
            local.rate_by_v += f.d2;
        }
        local
    }

    /// Whether the second derivatives of the coordinate are finite.
    fn row_is_finite(&self, a: usize) -> bool {
        [&self.mass, &self.momentum_by_q, &self.rate_by_q, &self.rate_by_v]
            .iter()
            .all(|matrix| matrix.row(a).iter().all(|entry| entry.is_finite()))
    }

    /// G.
    pub(super) fn rate(&self) -> SVector<T, N> {
        self.slope + self.force
    }
}

/// L and the force at every stage.
pub(super) fn locals<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    v: &LaneVector<T, N, S>,
) -> [Local<T, N>; S] {
    let q = problem.configurations(v);
    array::from_fn(|i| {
        problem.system.later(problem.elapsed(i), |system| Local::new(system, &lane(&q, i), &lane(v, i)))
    })
}

/// The first coordinate with a second derivative that is not finite at some stage.
pub(super) fn non_finite<T: Scalar, const N: usize, const S: usize>(
    locals: &[Local<T, N>; S],
) -> Option<usize> {
    (0..N).find(|&a| !locals.iter().all(|local| local.row_is_finite(a)))
}

/// ∂r/∂V of all stages, factored: P A = L U, rows by stage and coordinate.
pub(super) struct Factored<T, const N: usize, const S: usize> {
    /// `blocks[i][j]`: row block i, column block j.
    blocks: [[SMatrix<T, N, N>; S]; S],
    /// Which row stands in each place.
    order: [[usize; N]; S],
}

impl<T: Scalar, const N: usize, const S: usize> Factored<T, N, S> {
    /// The matrix of a step's equations, factored.
    ///
    /// # Errors
    /// [`Singular`], with the coordinate whose pivot is lost at some stage.
    pub(super) fn new<L: ForcedLagrangian<N, Scalar = T>>(
        problem: &Problem<'_, L, N, S>,
        locals: &[Local<T, N>; S],
    ) -> Result<Self, Singular> {
        let a = |i: usize, j: usize| problem.share(i, j);
        let blocks = array::from_fn(|i| {
            array::from_fn(|j| {
                let mut block = (locals[i].momentum_by_q - locals[j].rate_by_v) * a(i, j);
                for (k, local) in locals.iter().enumerate() {
                    block -= local.rate_by_q * (a(i, k) * a(k, j));
                }
                if i == j { block + locals[i].mass } else { block }
            })
        });
        let mut factored = Self { blocks, order: array::from_fn(|i| array::from_fn(|a| i * N + a)) };
        factored.eliminate()?;
        Ok(factored)
    }

    #[inline(always)]
    fn entry(&self, row: usize, column: usize) -> T {
        self.blocks[row / N][column / N][(row % N, column % N)]
    }

    #[inline(always)]
    fn entry_mut(&mut self, row: usize, column: usize) -> &mut T {
        &mut self.blocks[row / N][column / N][(row % N, column % N)]
    }

    /// Elimination with row exchanges, pivots chosen relative to their rows as they were.
    fn eliminate(&mut self) -> Result<(), Singular> {
        let size = S * N;
        let mut scale = [[T::zero(); N]; S];
        for row in 0..size {
            let largest =
                (0..size).fold(T::zero(), |largest, column| largest.max(self.entry(row, column).abs()));
            if largest > T::zero() {
                scale[row / N][row % N] = T::one() / largest;
            }
        }
        for k in 0..size {
            let (mut pivot, mut best) = (k, T::zero());
            for row in k..size {
                let candidate = self.entry(row, k).abs() * scale[row / N][row % N];
                if candidate > best {
                    (pivot, best) = (row, candidate);
                }
            }
            // Rounding has left nothing of the pivot; a NaN fails the comparison.
            let lost = T::EPSILON * T::constant(8.0 * size as f64);
            if best.partial_cmp(&lost) != Some(core::cmp::Ordering::Greater) {
                return Err(Singular { column: k % N });
            }
            if pivot != k {
                self.exchange(k, pivot);
                let (one, other) = (scale[k / N][k % N], scale[pivot / N][pivot % N]);
                (scale[k / N][k % N], scale[pivot / N][pivot % N]) = (other, one);
            }
            let reciprocal = T::one() / self.entry(k, k);
            for row in k + 1..size {
                let factor = self.entry(row, k) * reciprocal;
                *self.entry_mut(row, k) = factor;
                if factor != T::zero() {
                    for column in k + 1..size {
                        let upper = self.entry(k, column);
                        *self.entry_mut(row, column) -= factor * upper;
                    }
                }
            }
        }
        Ok(())
    }

    fn exchange(&mut self, one: usize, other: usize) {
        for column in 0..S * N {
            let (a, b) = (self.entry(one, column), self.entry(other, column));
            *self.entry_mut(one, column) = b;
            *self.entry_mut(other, column) = a;
        }
        let (a, b) = (self.order[one / N][one % N], self.order[other / N][other % N]);
        (self.order[one / N][one % N], self.order[other / N][other % N]) = (b, a);
    }

    /// x with A x = `right`.
    pub(super) fn solve(&self, right: &StageVector<T, N, S>) -> StageVector<T, N, S> {
        let size = S * N;
        let mut x: StageVector<T, N, S> = array::from_fn(|i| {
            SVector::from_fn(|a, _| {
                let row = self.order[i][a];
                right[row / N][row % N]
            })
        });
        for row in 0..size {
            let mut entry = x[row / N][row % N];
            for column in 0..row {
                entry -= self.entry(row, column) * x[column / N][column % N];
            }
            x[row / N][row % N] = entry;
        }
        for row in (0..size).rev() {
            let mut entry = x[row / N][row % N];
            for column in row + 1..size {
                entry -= self.entry(row, column) * x[column / N][column % N];
            }
            x[row / N][row % N] = entry / self.entry(row, row);
        }
        x
    }

    /// X with A X = `right`, column by column.
    pub(super) fn solve_columns<const K: usize>(
        &self,
        right: &StageColumns<T, N, S, K>,
    ) -> StageColumns<T, N, S, K> {
        let mut solution = [nalgebra::zero(); S];
        for column in 0..K {
            let x = self.solve(&array::from_fn(|i| right[i].column(column).into_owned()));
            for i in 0..S {
                let block: &mut SMatrix<T, N, K> = &mut solution[i];
                block.set_column(column, &x[i]);
            }
        }
        solution
    }

    /// x with Aᵀ x = `right`.
    pub(super) fn solve_transposed(&self, right: &StageVector<T, N, S>) -> StageVector<T, N, S> {
        let size = S * N;
        let mut y = *right;
        for row in 0..size {
            let mut entry = y[row / N][row % N];
            for column in 0..row {
                entry -= self.entry(column, row) * y[column / N][column % N];
            }
            y[row / N][row % N] = entry / self.entry(row, row);
        }
        for row in (0..size).rev() {
            let mut entry = y[row / N][row % N];
            for column in row + 1..size {
                entry -= self.entry(column, row) * y[column / N][column % N];
            }
            y[row / N][row % N] = entry;
        }
        let mut x = y;
        for row in 0..size {
            let place = self.order[row / N][row % N];
            x[place / N][place % N] = y[row / N][row % N];
        }
        x
    }
}
