//! θ put between the coordinates x, and taken out.

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::theory::samples::Pair;

/// `vector` with `entry` at `index`.
pub(super) fn with<S: Scalar, const N: usize, const K: usize>(
    vector: &SVector<S, K>,
    entry: S,
    index: usize,
) -> SVector<S, N> {
    SVector::from_fn(|i, _| match i {
        i if i < index => vector[i],
        i if i > index => vector[i - 1],
        _ => entry,
    })
}

/// `vector` without the entry at `index`.
pub(super) fn without<S: Scalar, const N: usize, const K: usize>(
    vector: &SVector<S, N>,
    index: usize,
) -> SVector<S, K> {
    SVector::from_fn(|i, _| vector[if i < index { i } else { i + 1 }])
}

/// The segment of x.
pub(super) fn shape<S: Scalar, const N: usize, const K: usize>(
    segment: &Pair<S, N>,
    index: usize,
) -> Pair<S, K> {
    Pair { q0: without(&segment.q0, index), q1: without(&segment.q1, index) }
}
