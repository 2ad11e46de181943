//! Caustics of a carried section, det Q_k = 0, located between the steps.
//!
//! Between two steps the characteristics are drawn straight, q(t) = (1 − t) c_k + t c_{k+1}, the path along
//! which the rules evaluate L. The fan folds where the frame of these lines is singular,
//!
//! ```text
//! det Q(t) = 0,     Q(t) = (1 − t) Q_k + t Q_{k+1},     0 < t ≤ 1
//! ```
//!
//! a generalised eigenvalue problem: with any regular Q(s), t = s − 1/μ for the real eigenvalues μ of
//! Q(s)⁻¹(Q_{k+1} − Q_k). Each is counted with its multiplicity, so that a double zero, which leaves the sign
//! of det Q_k as it was, is found; neither Q_k nor Q_{k+1} is inverted, unless it is the best conditioned of
//! the Q(s).
//!
//! Where the section is closed and ∂p0/∂q1 = −D2D1 L_d⁺ is symmetric and positive, the count is the number of
//! negative eigenvalues of Q_kᵀ (∂p0/∂q1) Q_{k+1}, the multiplicity of the focal points in (k, k+1] of
//! discrete Sturm theory (W. Kratz, Discrete oscillation, J. Difference Equ. Appl. 9, 2003).

use core::fmt;

use nalgebra::{DMatrix, SMatrix, SVector};

use super::Frame;
use crate::numbers::Scalar;
use crate::step::PhaseMatrix;

/// A zero of det Q on a characteristic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Caustic<const N: usize> {
    /// The label of the characteristic.
    pub label: SVector<f64, N>,
    /// The step k that it lies in: between q_k and q_{k+1}.
    pub step: usize,
    /// Where in the step, 0 < t ≤ 1; exactly 1 if det Q_{k+1} vanishes to rounding.
    pub fraction: f64,
    /// The configuration there, (1 − t) q_k + t q_{k+1}.
    pub q: SVector<f64, N>,
    /// Number of directions that fold at once.
    pub multiplicity: usize,
}

/// Regular Q(s) are sought among these: at both ends, between, and beyond.
const SHIFTS: [f64; 7] = [0.0, 1.0, 0.5, 0.25, 0.75, -0.5, 1.5];

/// A zero counted on a node is found again this near to the start of the next step.
const SAME: f64 = 1e-3;

/// The tangent plane of a carried section, and the caustics that it has met.
///
/// Its basis is made orthonormal at each step, which moves no zero of det Q. The frame itself would not do: a
/// direction in which the fan grows a millionfold hides in rounding what the others do.
pub(super) struct TangentPlane<S, const N: usize> {
    basis: Frame<S, N>,
    /// How many zeros were counted on the node that it is at.
    counted: usize,
}

impl<S: Scalar, const N: usize> TangentPlane<S, N> {
    pub(super) fn new(frame: &Frame<S, N>) -> Self {
        Self { basis: orthonormal(frame), counted: 0 }
    }

    /// Carries it over a step with the step matrix `a`: fractions of the step at which det Q vanishes, with
    /// their multiplicities, in order.
    pub(super) fn carry(&mut self, a: &PhaseMatrix<S, N>) -> Vec<(f64, usize)> {
        let next = self.basis.carried(a);
        let (zeros, counted) = zeros([&dynamic(&self.basis.q), &dynamic(&next.q)], self.counted);
        *self = Self { basis: orthonormal(&next), counted };
        zeros
    }
}

/// Another basis of the same plane, by Householder's QR decomposition of (Q, P).
fn orthonormal<S: Scalar, const N: usize>(frame: &Frame<S, N>) -> Frame<S, N> {
    // Powers of 2 against overflow of what is squared.
    let size = frame.q.amax().max(frame.p.amax());
    let stacked =
        DMatrix::from_fn(2 * N, N, |i, j| (if i < N { frame.q[(i, j)] } else { frame.p[(i - N, j)] }) / size);
    let basis = stacked.qr().q();
    Frame { q: SMatrix::from_fn(|i, j| basis[(i, j)]), p: SMatrix::from_fn(|i, j| basis[(N + i, j)]) }
}

/// The zeros of det Q(t) in 0 < t ≤ 1 with their multiplicities, in order; how many are at t = 1.
///
/// `counted` zeros at t = 0 belong to the step before.
fn zeros<S: Scalar>([from, to]: [&DMatrix<S>; 2], counted: usize) -> (Vec<(f64, usize)>, usize) {
    let apart = S::EPSILON.sqrt().widen();
    let mut candidates = real_zeros(from, to);
    // On which side of the node rounding puts them differs from node to node.
    candidates.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let again = candidates.iter().take(counted).filter(|t| t.abs() < SAME).count();
    candidates.drain(..again);
    candidates.retain(|t| 0.0 <= *t && *t <= 1.0 + apart);
    candidates.sort_by(f64::total_cmp);

    let mut zeros: Vec<(f64, usize)> = Vec::new();
    let mut at_end = 0;
    for t in candidates {
        let t = if (t - 1.0).abs() <= apart { 1.0 } else { t };
        at_end += usize::from(t == 1.0);
        match zeros.last_mut() {
            Some((last, multiplicity)) if t - *last <= apart => *multiplicity += 1,
            _ => zeros.push((t, 1)),
        }
    }
    (zeros, at_end)
}

/// The real t with det((1 − t) `from` + t `to`) = 0, each as often as its multiplicity.
fn real_zeros<S: Scalar>(from: &DMatrix<S>, to: &DMatrix<S>) -> Vec<f64> {
    let between = |s: f64| from * S::constant(1.0 - s) + to * S::constant(s);
    let conditions = SHIFTS.map(|s| {
        let values = between(s).singular_values();
        let condition = values.min() / values.max();
        if condition.is_finite() { condition.widen() } else { 0.0 }
    });
    let best = (0..SHIFTS.len()).max_by(|a, b| conditions[*a].total_cmp(&conditions[*b])).unwrap_or(0);
    let shift = SHIFTS[best];
    let Some(regular) = between(shift).try_inverse() else { return Vec::new() };
    let eigenvalues = (regular * (to - from)).complex_eigenvalues();
    let size = eigenvalues.iter().fold(S::zero(), |size, mu| size.max(mu.re.hypot(mu.im)));
    // Rounding splits a double eigenvalue into a pair √ε apart, which may be complex.
    let split = S::EPSILON.sqrt() * S::constant(64.0);
    eigenvalues
        .iter()
        .filter(|mu| mu.im.abs() <= split * size && mu.re.abs() > S::EPSILON * size)
        .map(|mu| shift - 1.0 / mu.re.widen())
        .collect()
}

fn dynamic<S: Scalar, const N: usize>(matrix: &SMatrix<S, N, N>) -> DMatrix<S> {
    DMatrix::from_fn(N, N, |i, j| matrix[(i, j)])
}

impl<const N: usize> fmt::Display for Caustic<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at k = {:.4}, q =", self.step as f64 + self.fraction)?;
        for entry in &self.q {
            write!(f, " {entry:.4}")?;
        }
        write!(f, ", multiplicity {}", self.multiplicity)
    }
}
