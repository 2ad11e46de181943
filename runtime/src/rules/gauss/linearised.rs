//! The stages' equations linearised, and elimination for all stages together.
//!
//! With M, B the derivatives of ∂L/∂v by v and by q, and K, C those of G by q and by v, at each stage, the
//! residual r_i = ∂L/∂v(Q_i, V_i) − P_i has
//!
//! ```text
//! ∂r_i/∂V_j = δ_ij M_i + h a_ij (B_i − C_j) − h² Σ_k a_ik K_k a_kj
//! ```

use core::array;

use nalgebra::{SMatrix, SVector};

use super::problem::Problem;
use crate::numbers::{LaneVector, Scalar, Singular, lanes::lane};
use crate::system::{ForcedLagrangian, derivatives_apart};

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
        let l = derivatives_apart(system, q, v);
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
    for a in 0..N {
        for local in locals {
            for matrix in [&local.mass, &local.momentum_by_q, &local.rate_by_q, &local.rate_by_v] {
                for b in 0..N {
                    if !matrix[(a, b)].is_finite() {
                        return Some(a);
                    }
                }
            }
        }
    }
    None
}

/// ∂r/∂V of all stages, factored: P A = L U, rows and columns by stage and coordinate.
pub(super) struct Factored<T, const N: usize, const S: usize> {
    /// `rows[i][a][j][b]`: the row of stage i and coordinate a, the column of stage j and coordinate b.
    rows: [[[[T; N]; S]; N]; S],
    /// Which row stands in each place, counted through all stages.
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
        let h_a = |i: usize, j: usize| problem.share(i, j);
        let mut rows = [[[[T::zero(); N]; S]; N]; S];
        for i in 0..S {
            for j in 0..S {
                let mut block = (locals[i].momentum_by_q - locals[j].rate_by_v) * h_a(i, j);
                for (k, local) in locals.iter().enumerate() {
                    block -= local.rate_by_q * (h_a(i, k) * h_a(k, j));
                }
                if i == j {
                    block += locals[i].mass;
                }
                for a in 0..N {
                    for b in 0..N {
                        rows[i][a][j][b] = block[(a, b)];
                    }
                }
            }
        }
        let (mut order, mut scale) = ([[0; N]; S], [[T::zero(); N]; S]);
        let all = rows.as_flattened_mut().as_flattened_mut().as_flattened_mut();
        T::factor(all, order.as_flattened_mut(), scale.as_flattened_mut())
            .map_err(|Singular { column }| Singular { column: column % N })?;
        Ok(Self { rows, order })
    }

    /// Whether det A > 0.
    pub(super) fn has_positive_determinant(&self) -> bool {
        let pivots = (0..S).flat_map(|i| (0..N).map(move |a| self.rows[i][a][i][a]));
        let mut positive = pivots.fold(true, |positive, pivot| positive ^ (pivot < T::zero()));
        let mut order = self.order.as_flattened();
        // Pairs of rows that stand in reverse.
        while let [row, after @ ..] = order {
            positive ^= after.iter().filter(|other| *other < row).count() % 2 == 1;
            order = after;
        }
        positive
    }

    /// X with A X = `right`.
    pub(super) fn solve<const K: usize>(&self, right: &StageColumns<T, N, S, K>) -> StageColumns<T, N, S, K> {
        let mut x = [SMatrix::<T, N, K>::zeros(); S];
        for k in 0..K {
            let mut column = self.order.map(|rows| {
                rows.map(|row| {
                    let (stage, coordinate) = within::<N, S>(row);
                    right[stage][(coordinate, k)]
                })
            });
            let rows = self.rows.as_flattened().as_flattened().as_flattened();
            T::substitute(rows, column.as_flattened_mut());
            for (x, column) in x.iter_mut().zip(column) {
                for (a, entry) in column.into_iter().enumerate() {
                    x[(a, k)] = entry;
                }
            }
        }
        x
    }

    /// x with Aᵀ x = `right`.
    pub(super) fn solve_transposed(&self, right: &StageVector<T, N, S>) -> StageVector<T, N, S> {
        let mut y = *right;
        for i in 0..S {
            for a in 0..N {
                for j in (0..S).take(i + 1) {
                    for b in (0..N).take(if j == i { a } else { N }) {
                        let known = y[j][b];
                        y[i][a] -= self.rows[j][b][i][a] * known;
                    }
                }
                y[i][a] /= self.rows[i][a][i][a];
            }
        }
        let mut x = y;
        for i in (0..S).rev() {
            for a in (0..N).rev() {
                let (i, a) = (i.min(S - 1), a.min(N - 1));
                for j in i..S {
                    for b in if j == i { a + 1 } else { 0 }..N {
                        let known = y[j][b];
                        y[i][a] -= self.rows[j][b][i][a] * known;
                    }
                }
                let (stage, coordinate) = within::<N, S>(self.order[i][a]);
                x[stage][coordinate] = y[i][a];
            }
        }
        x
    }
}

/// The stage and the coordinate of a row; says to the compiler that they are, so that no index has to be
/// checked.
#[cfg_attr(not(debug_assertions), inline(always))]
fn within<const N: usize, const S: usize>(row: usize) -> (usize, usize) {
    ((row / N).min(S - 1), (row % N).min(N - 1))
}
