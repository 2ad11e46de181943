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

/// Stage and coordinate.
type Place = (usize, usize);

/// ∂r/∂V of all stages, factored: P A = L U, rows and columns by stage and coordinate.
pub(super) struct Factored<T, const N: usize, const S: usize> {
    /// `rows[i][a][j][b]`: the row of stage i and coordinate a, the column of stage j and coordinate b.
    rows: [[[[T; N]; S]; N]; S],
    /// Which row stands in each place.
    order: [[Place; N]; S],
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
        let mut factored = Self { rows, order: array::from_fn(|i| array::from_fn(|a| (i, a))) };
        factored.eliminate()?;
        Ok(factored)
    }

    /// Elimination with row exchanges, pivots chosen relative to their rows as they were.
    fn eliminate(&mut self) -> Result<(), Singular> {
        let lost = T::EPSILON * T::constant(8.0 * (S * N) as f64);
        let mut scale = [[T::zero(); N]; S];
        for i in 0..S {
            for a in 0..N {
                let entries = self.rows[i][a].iter().flatten();
                let largest = entries.fold(T::zero(), |largest, entry| largest.max(entry.abs()));
                if largest > T::zero() {
                    scale[i][a] = T::one() / largest;
                }
            }
        }
        for i in 0..S {
            for a in 0..N {
                let (mut pivot, mut best) = ((i, a), T::zero());
                for k in i..S {
                    for c in if k == i { a } else { 0 }..N {
                        let candidate = self.rows[k][c][i][a].abs() * scale[k][c];
                        if candidate > best {
                            (pivot, best) = ((k, c), candidate);
                        }
                    }
                }
                // Rounding has left nothing of the pivot; a NaN fails the comparison.
                if best.partial_cmp(&lost) != Some(core::cmp::Ordering::Greater) {
                    return Err(Singular { column: a });
                }
                let (k, c) = within::<N, S>(pivot);
                if (k, c) != (i, a) {
                    (self.rows[i][a], self.rows[k][c]) = (self.rows[k][c], self.rows[i][a]);
                    (self.order[i][a], self.order[k][c]) = (self.order[k][c], self.order[i][a]);
                    (scale[i][a], scale[k][c]) = (scale[k][c], scale[i][a]);
                }
                let upper = self.rows[i][a];
                let reciprocal = T::one() / upper[i][a];
                for k in i..S {
                    for c in if k == i { a + 1 } else { 0 }..N {
                        let row = &mut self.rows[k][c];
                        let factor = row[i][a] * reciprocal;
                        row[i][a] = factor;
                        if factor != T::zero() {
                            for j in i..S {
                                for b in if j == i { a + 1 } else { 0 }..N {
                                    row[j][b] -= factor * upper[j][b];
                                }
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// Whether det A > 0.
    pub(super) fn has_positive_determinant(&self) -> bool {
        let mut positive = true;
        for i in 0..S {
            for a in 0..N {
                positive ^= self.rows[i][a][i][a] < T::zero();
                // Pairs of rows that stand in reverse.
                for k in 0..S {
                    for c in 0..N {
                        positive ^= (k, c) > (i, a) && self.order[k][c] < self.order[i][a];
                    }
                }
            }
        }
        positive
    }

    /// X with A X = `right`.
    pub(super) fn solve<const K: usize>(&self, right: &StageColumns<T, N, S, K>) -> StageColumns<T, N, S, K> {
        let mut x = [SMatrix::<T, N, K>::zeros(); S];
        for i in 0..S {
            for a in 0..N {
                let (stage, coordinate) = within::<N, S>(self.order[i][a]);
                for k in 0..K {
                    x[i][(a, k)] = right[stage][(coordinate, k)];
                }
                for j in (0..S).take(i + 1) {
                    for b in (0..N).take(if j == i { a } else { N }) {
                        let lower = self.rows[i][a][j][b];
                        for k in 0..K {
                            let known = x[j][(b, k)];
                            x[i][(a, k)] -= lower * known;
                        }
                    }
                }
            }
        }
        for i in (0..S).rev() {
            for a in (0..N).rev() {
                let (i, a) = within::<N, S>((i, a));
                for j in i..S {
                    for b in if j == i { a + 1 } else { 0 }..N {
                        let upper = self.rows[i][a][j][b];
                        for k in 0..K {
                            let known = x[j][(b, k)];
                            x[i][(a, k)] -= upper * known;
                        }
                    }
                }
                let pivot = self.rows[i][a][i][a];
                for k in 0..K {
                    x[i][(a, k)] /= pivot;
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
                let (i, a) = within::<N, S>((i, a));
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

/// The place itself; says to the compiler that it is one, so that no index has to be checked.
#[cfg_attr(not(debug_assertions), inline(always))]
fn within<const N: usize, const S: usize>((stage, coordinate): Place) -> Place {
    (stage.min(S - 1), coordinate.min(N - 1))
}
