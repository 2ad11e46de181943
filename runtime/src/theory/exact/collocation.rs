//! One step of the motion and of what varies with it, by Radau IIA of eight stages: order 15, L-stable.
//!
//! ```text
//! Q_i = q0 + τ Σ a_ij V_j,   P_i = p0 + τ Σ a_ij G_j,   ∂L/∂v(t_i, Q_i, V_i) = P_i,   G = ∂L/∂q + f
//! ```
//!
//! In (q, p) no derivative by the time is asked for: every stage sees L and f as they are at its own time,
//! and ∂²L/∂v∂t is in what the momenta do. The last stage is the end of the step. The same matrix that
//! Newton's method solves with carries the variations, of which the first are those of the equations above,
//! and so exact, and the second have sources besides:
//!
//! ```text
//! ∂L/∂v: L_vq δQ_i + L_vv δV_i + m_i = δP_i,   δG_i = (L_qq + f_q) δQ_i + (L_qv + f_v) δV_i + s_i
//! ```
//!
//! L-stability is for damping that is stiff on the step; none of this is the code of the rules that are
//! measured by it.

use core::num::NonZeroUsize;
use std::sync::OnceLock;

use nalgebra::{DMatrix, Dyn, LU, SVector};

use super::motion::{Dynamics, Local};
use super::work::Breakdown;
use crate::system::ActingForce;
use crate::theory::legendre::{GaussLegendre, polynomials};

/// Stages of a step.
pub(super) const STAGES: usize = 8;

/// Iterations of Newton's method for the stages. Where it needs more, a shorter step is cheaper.
const MAX_ITERATIONS: usize = 12;

/// A correction so small, in units of the velocities, is the last: the next would be its square.
const LAST: f64 = 1e-9;

struct Coefficients {
    /// c_i, ascending to 1.
    nodes: [f64; STAGES],
    /// a_ij; the last row is b_j.
    matrix: [[f64; STAGES]; STAGES],
}

fn coefficients() -> &'static Coefficients {
    static COEFFICIENTS: OnceLock<Coefficients> = OnceLock::new();
    COEFFICIENTS.get_or_init(|| {
        let nodes = nodes();
        // The integrands are polynomials of degree 7: eight nodes of Gauss are exact.
        const EXACT: NonZeroUsize = NonZeroUsize::new(STAGES).unwrap();
        let gauss = GaussLegendre::new(EXACT);
        let basis = |j: usize, x: f64| {
            let others = nodes.iter().enumerate().filter(|(k, _)| *k != j);
            others.fold(1.0, |product, (_, node)| product * (x - node) / (nodes[j] - node))
        };
        let integral = |i: usize, j: usize| gauss.integrate(0.0, nodes[i], |x: f64| basis(j, x));
        Coefficients { nodes, matrix: core::array::from_fn(|i| core::array::from_fn(|j| integral(i, j))) }
    })
}

/// The zeros of P_8 − P_7 on [−1, 1], taken to [0, 1].
fn nodes() -> [f64; STAGES] {
    let count = STAGES as f64;
    let at = |x: f64| {
        let [p, q] = polynomials(STAGES, x);
        (q.0 - p.0, q.1 - p.1)
    };
    core::array::from_fn(|i| {
        if i + 1 == STAGES {
            return 1.0;
        }
        // From the nodes of Chebyshev and Radau.
        let mut x = (2.0 * core::f64::consts::PI * (count - 1.0 - i as f64) / (2.0 * count - 1.0)).cos();
        for _ in 0..50 {
            let (value, slope) = at(x);
            x -= value / slope;
        }
        0.5 * (1.0 + x)
    })
}

/// One stage of a step.
pub(super) struct Stage<const N: usize> {
    /// The time since the start of the segment.
    pub(super) time: f64,
    /// τ b_i, the weight of the stage in integrals.
    pub(super) weight: f64,
    pub(super) q: SVector<f64, N>,
    pub(super) v: SVector<f64, N>,
    pub(super) local: Local<N>,
}

/// A step of the motion.
pub(super) struct Step<const N: usize> {
    length: f64,
    pub(super) stages: Vec<Stage<N>>,
    /// Momentum at the end.
    pub(super) p: SVector<f64, N>,
    /// √M_aa of each coordinate: in these units no coordinate drowns another.
    unit: SVector<f64, N>,
    factored: LU<f64, Dyn, Dyn>,
}

/// A variation along a step.
pub(super) struct Varied<const N: usize> {
    /// δq and δv at the stages.
    pub(super) stages: Vec<(SVector<f64, N>, SVector<f64, N>)>,
    /// δq and δp at the end.
    pub(super) end: (SVector<f64, N>, SVector<f64, N>),
}

/// The sources of a second variation at each stage, beside its first-order terms: m_i in ∂L/∂v, s_i in the
/// rate of the momentum.
pub(super) type Source<const N: usize> = Vec<(SVector<f64, N>, SVector<f64, N>)>;

/// (q, p), and the velocity that Newton's method starts from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Phase<const N: usize> {
    pub(super) q: SVector<f64, N>,
    pub(super) p: SVector<f64, N>,
    pub(super) v: SVector<f64, N>,
}

impl<const N: usize> Step<N> {
    /// The end of the step.
    pub(super) fn end(&self) -> Phase<N> {
        let last = &self.stages[STAGES - 1];
        Phase { q: last.q, p: self.p, v: last.v }
    }

    /// The variations that start as `starts`, pairs (δq, δp), with their sources.
    pub(super) fn vary(
        &self,
        starts: &[(SVector<f64, N>, SVector<f64, N>)],
        sources: Option<&[Source<N>]>,
    ) -> Vec<Varied<N>> {
        let Coefficients { matrix, .. } = coefficients();
        let source = |column: usize, i: usize| match sources {
            Some(sources) => sources[column][i],
            None => (SVector::zeros(), SVector::zeros()),
        };
        let mut right = DMatrix::zeros(STAGES * N, starts.len());
        for (column, (q, p)) in starts.iter().enumerate() {
            let rates: Vec<SVector<f64, N>> =
                (0..STAGES).map(|j| self.stages[j].local.rate_by_q() * q + source(column, j).1).collect();
            for (i, stage) in self.stages.iter().enumerate() {
                let rate = weighted(&matrix[i], self.length, |j| rates[j]);
                let own = p + rate - stage.local.l.d12.tr_mul(q) - source(column, i).0;
                right.view_mut((i * N, column), (N, 1)).copy_from(&own.component_div(&self.unit));
            }
        }
        // Newton's method has solved with the same matrix, so that it is regular.
        let solved = self.factored.solve(&right).unwrap_or_else(|| right.map(|_| f64::NAN));
        starts
            .iter()
            .enumerate()
            .map(|(column, (q, p))| {
                let v: Vec<SVector<f64, N>> = (0..STAGES)
                    .map(|i| SVector::from_fn(|a, _| solved[(i * N + a, column)] / self.unit[a]))
                    .collect();
                let stages: Vec<_> =
                    (0..STAGES).map(|i| (q + weighted(&matrix[i], self.length, |j| v[j]), v[i])).collect();
                let rate = |j: usize| {
                    let local = &self.stages[j].local;
                    local.rate_by_q() * stages[j].0 + local.rate_by_v() * stages[j].1 + source(column, j).1
                };
                let p = p + weighted(&matrix[STAGES - 1], self.length, rate);
                let end = (stages[STAGES - 1].0, p);
                Varied { stages, end }
            })
            .collect()
    }
}

/// τ Σ a_j x_j.
fn weighted<const N: usize>(
    row: &[f64; STAGES],
    length: f64,
    vector: impl Fn(usize) -> SVector<f64, N>,
) -> SVector<f64, N> {
    let mut sum = [0.0; N];
    for (j, share) in row.iter().enumerate() {
        for (sum, x) in sum.iter_mut().zip(vector(j).as_slice()) {
            *sum += x * share;
        }
    }
    SVector::from(sum) * length
}

impl<L: ActingForce<N, Scalar = f64>, const N: usize> Dynamics<'_, L, N> {
    /// The step of `length` from `start`, `time` after the start of the segment.
    pub(super) fn step(&self, time: f64, start: &Phase<N>, length: f64) -> Result<Step<N>, Breakdown> {
        let Coefficients { nodes, matrix } = coefficients();
        let mut v = [start.v; STAGES];
        let mut previous = f64::INFINITY;
        let mut is_last = false;
        for _ in 0..MAX_ITERATIONS {
            let mut stages = Vec::with_capacity(STAGES);
            for i in 0..STAGES {
                let q = start.q + weighted(&matrix[i], length, |j| v[j]);
                let time = time + nodes[i] * length;
                let local = self.local(time, &q, &v[i])?;
                stages.push(Stage { time, weight: length * matrix[STAGES - 1][i], q, v: v[i], local });
            }
            let rates: Vec<_> = stages.iter().map(|stage| stage.local.rate()).collect();
            let rate = |j: usize| rates[j];
            let unit = SVector::<f64, N>::from_fn(|a, _| unit_of(&stages[0].local, a));
            let factored = Blocks::of(&stages).jacobian(unit.as_slice(), length).lu();
            if is_last {
                let p = start.p + weighted(&matrix[STAGES - 1], length, rate);
                return Ok(Step { length, p, stages, unit, factored });
            }
            let mut residual = DMatrix::zeros(STAGES * N, 1);
            for (i, stage) in stages.iter().enumerate() {
                let r = stage.local.l.d2 - start.p - weighted(&matrix[i], length, rate);
                residual.view_mut((i * N, 0), (N, 1)).copy_from(&r.component_div(&unit));
            }
            let correction = factored.solve(&residual).ok_or(Breakdown::NotSolved)?;
            let (mut size, mut scale) = (0.0_f64, 0.0_f64);
            for (i, v) in v.iter_mut().enumerate() {
                for a in 0..N {
                    v[a] -= correction[(i * N + a, 0)] / unit[a];
                    size = size.max(correction[(i * N + a, 0)].abs());
                    scale = scale.max(v[a].abs() * unit[a]);
                }
            }
            if !correction.iter().all(|entry| entry.is_finite()) || size > 4.0 * previous {
                return Err(Breakdown::NotSolved);
            }
            // What rounding leaves of a motion at rest shrinks no more.
            is_last = size <= LAST * scale || size == 0.0 || (size <= 1e-6 * scale && size > 0.5 * previous);
            previous = size;
        }
        Err(Breakdown::NotSolved)
    }
}

/// √M_aa, or of the largest entry in the row of a coordinate that has none.
pub(super) fn unit_of<const N: usize>(local: &Local<N>, a: usize) -> f64 {
    let own = local.l.d22[(a, a)].abs();
    if own > 0.0 { own.sqrt() } else { local.l.d22.row(a).amax().sqrt() }
}

/// The blocks that Newton's matrix is made of: n×n, by column, one stage after the other.
#[derive(Default)]
struct Blocks {
    /// L_vv.
    mass: Vec<f64>,
    /// L_vq.
    by_q: Vec<f64>,
    /// G_v.
    rate_by_v: Vec<f64>,
    /// G_q.
    rate_by_q: Vec<f64>,
}

impl Blocks {
    fn of<const N: usize>(stages: &[Stage<N>]) -> Self {
        let mut blocks = Self::default();
        for Stage { local, .. } in stages {
            blocks.mass.extend_from_slice(local.l.d22.as_slice());
            blocks.by_q.extend_from_slice(local.l.d12.transpose().as_slice());
            blocks.rate_by_v.extend_from_slice(local.rate_by_v().as_slice());
            blocks.rate_by_q.extend_from_slice(local.rate_by_q().as_slice());
        }
        blocks
    }

    /// ∂r_i/∂V_j = δ_ij L_vv + τ a_ij (L_vq,i − G_v,j) − τ² Σ_k a_ik G_q,k a_kj of r_i = ∂L/∂v − P_i, both
    /// sides in `unit`s. On slices: compiled once, not for each number of coordinates.
    fn jacobian(&self, unit: &[f64], length: f64) -> DMatrix<f64> {
        let Coefficients { matrix, .. } = coefficients();
        let n = unit.len();
        let mut jacobian = DMatrix::zeros(STAGES * n, STAGES * n);
        for i in 0..STAGES {
            for j in 0..STAGES {
                let share = length * matrix[i][j];
                let shares: [f64; STAGES] =
                    core::array::from_fn(|k| length * matrix[i][k] * (length * matrix[k][j]));
                for b in 0..n {
                    for a in 0..n {
                        let at = |stage: usize| (stage * n + b) * n + a;
                        let mut entry = (self.by_q[at(i)] - self.rate_by_v[at(j)]) * share;
                        for (k, share) in shares.iter().enumerate() {
                            entry -= self.rate_by_q[at(k)] * share;
                        }
                        if i == j {
                            entry += self.mass[at(i)];
                        }
                        jacobian[(i * n + a, j * n + b)] = entry / unit[a] / unit[b];
                    }
                }
            }
        }
        jacobian
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_coefficients_fulfil_the_order_conditions() {
        let Coefficients { nodes, matrix } = coefficients();
        assert!(nodes.windows(2).all(|pair| pair[0] < pair[1]) && nodes[0] > 0.0);
        let sum = |row: &[f64; STAGES], power: i32| -> f64 {
            row.iter().zip(nodes).map(|(share, node)| share * node.powi(power)).sum()
        };
        // Quadrature of order 15, and no more; stages of order 8.
        for k in 1..=15 {
            assert!((sum(&matrix[STAGES - 1], k - 1) * f64::from(k) - 1.0).abs() < 1e-14, "{k}");
        }
        assert!((sum(&matrix[STAGES - 1], 15) * 16.0 - 1.0).abs() > 1e-10);
        for (row, node) in matrix.iter().zip(nodes) {
            for k in 1..=8 {
                assert!((sum(row, k - 1) * f64::from(k) - node.powi(k)).abs() < 1e-14, "{node} {k}");
            }
        }
    }
}
