//! Caustics of a carried section, det Q_k = 0, located between the steps.
//!
//! Between two steps the characteristics are drawn straight, q(t) = (1 − t) c_k + t c_{k+1}, the path along which the rules
//! evaluate L. The fan folds where the frame of these lines is singular,
//!
//! ```text
//! det Q(t) = 0,     Q(t) = (1 − t) Q_k + t Q_{k+1},     0 < t ≤ 1
//! ```
//!
//! a generalised eigenvalue problem: with any regular Q(s), t = s − 1/μ for the real eigenvalues μ of
//! Q(s)⁻¹(Q_{k+1} − Q_k). Each is counted with its multiplicity, so that a double zero, which leaves the sign of det Q_k as
//! it was, is found; neither Q_k nor Q_{k+1} is inverted, unless it is the best conditioned of the Q(s).
//!
//! Where the section is closed and ∂p0/∂q1 = −D2D1 L_d⁺ is symmetric and positive, the count is the number of negative
//! eigenvalues of Q_kᵀ (∂p0/∂q1) Q_{k+1}, the multiplicity of the focal points in (k, k+1] of discrete Sturm theory
//! (W. Kratz, Discrete oscillation, J. Difference Equ. Appl. 9, 2003).

use core::fmt;

use nalgebra::{DMatrix, SMatrix, SVector};

use super::Characteristic;
use crate::Scalar;

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

impl<S: Scalar, const N: usize> Characteristic<S, N> {
    /// The zeros of det Q_k along this characteristic, in order.
    ///
    /// A frame counts as singular on a node k if its smallest singular value is below √ε of the frames' size there. A pair
    /// of zeros closer than √ε to each other is one caustic of multiplicity 2.
    #[must_use]
    pub fn caustics(&self) -> Vec<Caustic<N>> {
        // A frame that has overflowed ends the search; `carry` does not return one.
        let finite = self.frames.iter().take_while(|frame| frame.q.iter().all(|entry| entry.is_finite()));
        let frames: Vec<DMatrix<S>> = finite.map(|frame| dynamic(&frame.q)).collect();
        let kernels: Vec<usize> = (0..frames.len()).map(|k| kernel(&frames, k)).collect();
        let mut caustics = Vec::new();
        for k in 1..frames.len() {
            for (fraction, multiplicity) in zeros([&frames[k - 1], &frames[k]], [kernels[k - 1], kernels[k]])
            {
                let [from, to] = [&self.states[k - 1].q, &self.states[k].q].map(|q| q.map(Scalar::widen));
                caustics.push(Caustic {
                    label: self.label.map(Scalar::widen),
                    step: k - 1,
                    fraction,
                    q: from * (1.0 - fraction) + to * fraction,
                    multiplicity,
                });
            }
        }
        caustics
    }
}

/// Dimension of the kernel of Q_k, to rounding.
fn kernel<S: Scalar>(frames: &[DMatrix<S>], k: usize) -> usize {
    let neighbours = &frames[k.saturating_sub(1)..(k + 2).min(frames.len())];
    let size = neighbours.iter().fold(S::zero(), |size, frame| size.max(frame.amax()));
    let threshold = size * S::EPSILON.sqrt();
    frames[k].singular_values().iter().filter(|value| **value <= threshold).count()
}

/// The zeros of det Q(t) in 0 < t ≤ 1 with their multiplicities, in order.
fn zeros<S: Scalar>([from, to]: [&DMatrix<S>; 2], [at_from, at_to]: [usize; 2]) -> Vec<(f64, usize)> {
    let mut candidates = real_zeros(from, to);
    // Those on the nodes are known by their kernels: the nearest ones are theirs, and the first node's are counted already.
    candidates.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    candidates.drain(..at_from.min(candidates.len()));
    candidates.sort_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs()));
    candidates.drain(..at_to.min(candidates.len()));
    candidates.retain(|t| (0.0..1.0).contains(t));
    candidates.sort_by(f64::total_cmp);

    let mut zeros: Vec<(f64, usize)> = Vec::new();
    let apart = S::EPSILON.sqrt().widen();
    for t in candidates {
        match zeros.last_mut() {
            Some((last, multiplicity)) if t - *last <= apart => *multiplicity += 1,
            _ => zeros.push((t, 1)),
        }
    }
    if at_to > 0 {
        zeros.push((1.0, at_to));
    }
    zeros
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
