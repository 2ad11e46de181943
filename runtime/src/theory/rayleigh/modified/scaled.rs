//! A matrix on (q, p) in coordinates that are alike, so that no unit decides what rounding is.

use nalgebra::{DMatrix, SMatrix, SVector};

use crate::numbers::Scalar;
use crate::step::PhaseMatrix;
use crate::theory::rayleigh::modified::ModifiedLinearSystemError;

/// Rounding of ∂p1/∂q0, in units of ε (∂q1/∂p0)⁻¹: what the ends of a step make of it is a difference of
/// such.
pub(super) const ROUNDINGS: f64 = 16.0;

/// Scales x = S⁻¹q, y = Sp in which q and p, and the coordinates, are alike; `epsilon` is the rounding of A.
pub(super) fn scales<const N: usize>(a: &PhaseMatrix<f64, N>, epsilon: f64) -> SVector<f64, N> {
    let by_momentum = SVector::<f64, N>::from_fn(|i, _| match a.q_by_p.row(i).amax() {
        size if size > 0.0 => size.sqrt(),
        _ => 1.0,
    });
    let scaled = |block: &SMatrix<f64, N, N>, power: i32| {
        block.map_with_location(|i, j, entry| entry * (by_momentum[i] * by_momentum[j]).powi(power)).amax()
    };
    let (b, c) = (scaled(&a.q_by_p, -1), scaled(&a.p_by_q, 1));
    // Free coordinates have c = 0, to rounding.
    let between = if c > ROUNDINGS * epsilon * b { (b / c).sqrt().sqrt() } else { 1.0 };
    by_momentum * between
}

/// The blocks of (q, p) from those of (x, y), or with 1/s for `s` the other way.
pub(super) fn rescaled<const N: usize>(a: &PhaseMatrix<f64, N>, s: &SVector<f64, N>) -> PhaseMatrix<f64, N> {
    PhaseMatrix {
        q_by_q: a.q_by_q.map_with_location(|i, j, entry| entry * s[i] / s[j]),
        q_by_p: a.q_by_p.map_with_location(|i, j, entry| entry * s[i] * s[j]),
        p_by_q: a.p_by_q.map_with_location(|i, j, entry| entry / (s[i] * s[j])),
        p_by_p: a.p_by_p.map_with_location(|i, j, entry| entry * s[j] / s[i]),
    }
}

/// In `f64`.
pub(super) fn widened<S: Scalar, const N: usize>(a: &PhaseMatrix<S, N>) -> PhaseMatrix<f64, N> {
    let widen = |block: &SMatrix<S, N, N>| block.map(Scalar::widen);
    PhaseMatrix {
        q_by_q: widen(&a.q_by_q),
        q_by_p: widen(&a.q_by_p),
        p_by_q: widen(&a.p_by_q),
        p_by_p: widen(&a.p_by_p),
    }
}

/// The blocks as one matrix.
pub(super) fn assembled<const N: usize>(a: &PhaseMatrix<f64, N>) -> DMatrix<f64> {
    let mut whole = DMatrix::zeros(2 * N, 2 * N);
    for (block, at) in [(&a.q_by_q, (0, 0)), (&a.q_by_p, (0, N)), (&a.p_by_q, (N, 0)), (&a.p_by_p, (N, N))] {
        whole.view_mut(at, (N, N)).copy_from(block);
    }
    whole
}

/// The blocks of one matrix.
pub(super) fn blocks<const N: usize>(whole: &DMatrix<f64>) -> PhaseMatrix<f64, N> {
    let block = |row, column| SMatrix::from_fn(|i, j| whole[(row + i, column + j)]);
    PhaseMatrix { q_by_q: block(0, 0), q_by_p: block(0, N), p_by_q: block(N, 0), p_by_p: block(N, N) }
}

/// Fails where an entry is not finite.
pub(super) fn require_finite<const N: usize>(
    a: &PhaseMatrix<f64, N>,
    sample: usize,
) -> Result<(), ModifiedLinearSystemError> {
    let is_finite = [&a.q_by_q, &a.q_by_p, &a.p_by_q, &a.p_by_p]
        .iter()
        .all(|block| block.iter().all(|entry| entry.is_finite()));
    if is_finite { Ok(()) } else { Err(ModifiedLinearSystemError::NonFinite { sample }) }
}
