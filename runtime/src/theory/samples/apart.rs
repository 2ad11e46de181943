//! Samples that are held against each other: which lie apart, and which are asked beside those given.

use nalgebra::SVector;

use super::Pair;
use crate::numbers::Scalar;
use crate::step::State;
use crate::theory::verdict::Tolerance;

/// A sample in 2N coordinates of two kinds.
pub(crate) trait Sample<S: Scalar, const N: usize>: Copy {
    fn parts(&self) -> [SVector<S, N>; 2];

    fn from_parts(parts: [SVector<S, N>; 2]) -> Self;
}

impl<S: Scalar, const N: usize> Sample<S, N> for State<S, N> {
    fn parts(&self) -> [SVector<S, N>; 2] {
        [self.q, self.p]
    }

    fn from_parts([q, p]: [SVector<S, N>; 2]) -> Self {
        Self { q, p }
    }
}

/// By the start and the displacement.
impl<S: Scalar, const N: usize> Sample<S, N> for Pair<S, N> {
    fn parts(&self) -> [SVector<S, N>; 2] {
        [self.q0, self.q1 - self.q0]
    }

    fn from_parts([q0, by]: [SVector<S, N>; 2]) -> Self {
        Self { q0, q1: q0 + by }
    }
}

/// Closer than this share of their size two samples are one: √τ, since a change of slope 0 is then below τ.
fn resolution<S: Scalar>() -> f64 {
    Tolerance::rounding::<S>().sqrt()
}

/// The size of each coordinate over some samples.
pub(crate) struct Sizes<const N: usize>([SVector<f64, N>; 2]);

impl<const N: usize> Sizes<N> {
    pub(crate) fn of<S: Scalar, T: Sample<S, N>>(samples: impl IntoIterator<Item = T>) -> Self {
        let mut sizes = [SVector::<f64, N>::zeros(); 2];
        for sample in samples {
            for (size, part) in sizes.iter_mut().zip(sample.parts()) {
                size.zip_apply(&part, |size, entry| *size = size.max(entry.widen().abs()));
            }
        }
        Self(sizes)
    }

    /// Whether the samples differ by more than what a derivative resolves, in a coordinate.
    pub(crate) fn are_apart<S: Scalar, T: Sample<S, N>>(&self, one: &T, other: &T) -> bool {
        let (one, other) = (one.parts(), other.parts());
        (0..2).any(|kind| {
            (0..N).any(|i| {
                let distance = (one[kind][i] - other[kind][i]).widen().abs();
                distance > resolution::<S>() * self.0[kind][i]
            })
        })
    }
}

/// The number of samples that lie apart from each other, counted up to `enough`.
pub(crate) fn different<S: Scalar, T: Sample<S, N>, const N: usize>(
    samples: &[T],
    sizes: &Sizes<N>,
    enough: usize,
) -> usize {
    let mut known: Vec<&T> = Vec::new();
    for sample in samples {
        if known.len() < enough && known.iter().all(|other| sizes.are_apart(*other, sample)) {
            known.push(sample);
        }
    }
    known.len()
}

/// Where samples are asked between two of those given: the golden section, since even functions are the
/// same at both of a mirrored pair, and odd ones 0 between.
const BETWEEN: f64 = 0.618_033_988_749_894_9;

/// Samples beside the first: one for each coordinate, which leads towards the sample that differs most in
/// it, or is changed by its own size where none differs, or by its unit where that is small too: around 0
/// samples have no size that could say which are far.
///
/// They fill 2N directions whatever the samples are, and stay among them where those fill a box.
pub(crate) fn around<S: Scalar, T: Sample<S, N>, const N: usize>(
    samples: &[T],
    sizes: &Sizes<N>,
    units: [f64; 2],
) -> Vec<T> {
    let Some(first) = samples.first() else { return Vec::new() };
    let mut beside = Vec::with_capacity(2 * N);
    for (kind, i) in (0..2).flat_map(|kind| (0..N).map(move |i| (kind, i))) {
        let mut parts = first.parts();
        let from = parts[kind][i];
        let distance = |value: S| (value - from).widen().abs();
        let furthest = samples.iter().map(|sample| sample.parts()[kind][i]).fold(from, |furthest, value| {
            if distance(value) > distance(furthest) { value } else { furthest }
        });
        let (size, unit) = (sizes.0[kind][i], units[kind]);
        if distance(furthest) > resolution::<S>() * size.max(unit) {
            parts[kind][i] += (furthest - from) * S::constant(BETWEEN);
        } else {
            parts[kind][i] += S::constant(if size > resolution::<S>() * unit { size } else { unit });
        }
        beside.push(T::from_parts(parts));
    }
    beside
}
