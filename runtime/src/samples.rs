//! Where the checkers look: segments (q0, q1) of Q×Q, points of a region, and the worst of what was found there.
//!
//! A checker's verdict is about the points that it was given. Points of a region, spread evenly by [`region`] and
//! [`segments`], speak for the region; those of one trajectory ([`Segment::along`]) for that trajectory alone.

use core::fmt;

use nalgebra::SVector;

use crate::Scalar;

/// A segment (q0, q1), a point of Q×Q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<S, const N: usize> {
    /// Configuration at the start.
    pub q0: SVector<S, N>,
    /// Configuration at the end.
    pub q1: SVector<S, N>,
}

impl<S: Scalar, const N: usize> Segment<S, N> {
    /// The segment (q0, q1).
    pub fn new(q0: impl Into<SVector<S, N>>, q1: impl Into<SVector<S, N>>) -> Self {
        Self { q0: q0.into(), q1: q1.into() }
    }

    /// The segments of a discrete path q₀, q₁, q₂, …, such as the configurations of a trajectory.
    #[must_use]
    pub fn along(path: &[SVector<S, N>]) -> Vec<Self> {
        path.windows(2).map(|pair| Self { q0: pair[0], q1: pair[1] }).collect()
    }

    /// The same segment in `f64`.
    #[must_use]
    pub fn widen(&self) -> Segment<f64, N> {
        Segment { q0: self.q0.map(Scalar::widen), q1: self.q1.map(Scalar::widen) }
    }
}

impl<S: fmt::Display, const N: usize> fmt::Display for Segment<S, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("q0 = ")?;
        coordinates(f, &self.q0)?;
        f.write_str(", q1 = ")?;
        coordinates(f, &self.q1)
    }
}

/// A point (q, v) of TQ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentPoint<S, const N: usize> {
    /// Configuration.
    pub q: SVector<S, N>,
    /// Velocity.
    pub v: SVector<S, N>,
}

/// Writes (x, y, …).
pub(crate) fn coordinates<S: fmt::Display, const N: usize>(
    f: &mut fmt::Formatter<'_>,
    vector: &SVector<S, N>,
) -> fmt::Result {
    f.write_str("(")?;
    for (index, entry) in vector.iter().enumerate() {
        if index > 0 {
            f.write_str(", ")?;
        }
        write!(f, "{entry:.4}")?;
    }
    f.write_str(")")
}

/// `count` points spread evenly over the box from `low` to `high`: the additive sequence with the ratios g⁻¹, g⁻², …,
/// g the positive root of x^{N+1} = x + 1 (the generalised golden ratio; Roberts, 2018).
///
/// The same points each time: a verdict can be repeated.
#[must_use]
pub fn region<S: Scalar, const N: usize>(
    low: impl Into<SVector<S, N>>,
    high: impl Into<SVector<S, N>>,
    count: usize,
) -> Vec<SVector<S, N>> {
    let (low, high) = (low.into(), high.into());
    let ratios = Ratios::new(N);
    (0..count)
        .map(|k| SVector::from_fn(|i, _| low[i] + (high[i] - low[i]) * S::constant(ratios.share(k, i))))
        .collect()
}

/// `count` segments: q0 in the box from `low` to `high`, each coordinate of q1 − q0 between ∓`reach`.
///
/// Choose `reach` like the displacements that occur, about h times the speed.
#[must_use]
pub fn segments<S: Scalar, const N: usize>(
    low: impl Into<SVector<S, N>>,
    high: impl Into<SVector<S, N>>,
    reach: impl Into<SVector<S, N>>,
    count: usize,
) -> Vec<Segment<S, N>> {
    let (low, high, reach) = (low.into(), high.into(), reach.into());
    let ratios = Ratios::new(2 * N);
    (0..count)
        .map(|k| {
            let share = |i| S::constant(ratios.share(k, i));
            let q0 = SVector::from_fn(|i, _| low[i] + (high[i] - low[i]) * share(i));
            let both_ways = |i| share(N + i) * S::constant(2.0) - S::one();
            Segment { q0, q1: SVector::from_fn(|i, _| q0[i] + reach[i] * both_ways(i)) }
        })
        .collect()
}

/// `count` points (q, v): q in the box from `low` to `high`, each coordinate of v between ∓`speed`.
#[must_use]
pub fn tangent_points<S: Scalar, const N: usize>(
    low: impl Into<SVector<S, N>>,
    high: impl Into<SVector<S, N>>,
    speed: impl Into<SVector<S, N>>,
    count: usize,
) -> Vec<TangentPoint<S, N>> {
    segments(low, high, speed, count)
        .into_iter()
        .map(|segment| TangentPoint { q: segment.q0, v: segment.q1 - segment.q0 })
        .collect()
}

/// The additive quasi-random sequence in a number of dimensions.
struct Ratios(f64);

impl Ratios {
    fn new(dimensions: usize) -> Self {
        // The fixed point of x = (1 + x)^{1/(d+1)}: the map contracts by less than ½, 64 iterations are plenty.
        let exponent = 1.0 / (dimensions as f64 + 1.0);
        Self((0..64).fold(1.5_f64, |g, _| (1.0 + g).powf(exponent)))
    }

    /// Coordinate `axis` of point `k`, in [0, 1).
    fn share(&self, k: usize, axis: usize) -> f64 {
        (0.5 + (k as f64 + 1.0) * self.0.powf(-(axis as f64 + 1.0))).fract()
    }
}

/// The largest magnitude of a quantity over the samples, and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst<const N: usize> {
    /// The value with the largest magnitude.
    pub value: f64,
    /// The segment where it is taken.
    pub at: Segment<f64, N>,
}

impl<const N: usize> Worst<N> {
    /// The largest |value| of a list that is not empty.
    pub(crate) fn of<S: Scalar>(
        segments: &[Segment<S, N>],
        mut value: impl FnMut(usize, &Segment<S, N>) -> f64,
    ) -> Result<Self, SampleError> {
        let mut worst: Option<Self> = None;
        for (index, segment) in segments.iter().enumerate() {
            let value = value(index, segment);
            if !value.is_finite() {
                return Err(SampleError::NonFinite { index });
            }
            if worst.is_none_or(|worst| value.abs() > worst.value.abs()) {
                worst = Some(Self { value, at: segment.widen() });
            }
        }
        worst.ok_or(SampleError::TooFew { given: 0, needed: 1 })
    }
}

impl<const N: usize> fmt::Display for Worst<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:+.3e} at {}", self.value, self.at)
    }
}

/// What counts as zero: `relative` × `scale`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Rounding allowed, relative to the terms that the quantity is a sum of.
    pub relative: f64,
    /// Size of those terms: what the quantity could be if nothing cancelled.
    pub scale: f64,
}

impl Tolerance {
    /// Rounding that a checker allows unless told otherwise, in units of ε: a derivative of L or R takes some hundreds of
    /// roundings.
    pub(crate) const ROUNDINGS: f64 = 1024.0;

    /// The default for the scalar type `S`.
    #[must_use]
    pub fn rounding<S: Scalar>() -> f64 {
        Self::ROUNDINGS * S::EPSILON.widen()
    }

    /// The largest magnitude that counts as zero.
    #[must_use]
    pub fn bound(&self) -> f64 {
        self.relative * self.scale
    }

    /// Whether `value` counts as zero.
    #[must_use]
    pub fn covers(&self, value: f64) -> bool {
        value.abs() <= self.bound()
    }
}

impl fmt::Display for Tolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.1e} = {:.1e} × {:.3e}, the size of the terms", self.bound(), self.relative, self.scale)
    }
}

/// Why the samples given cannot be judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SampleError {
    /// Fewer samples than unknowns.
    TooFew {
        /// Samples given.
        given: usize,
        /// The least number that decides.
        needed: usize,
    },
    /// A quantity is NaN or infinite at a sample.
    NonFinite {
        /// Number of the sample, from 0.
        index: usize,
    },
}

impl fmt::Display for SampleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew { given, needed } => {
                write!(f, "{given} samples given, at least {needed} needed to decide; give more")
            }
            Self::NonFinite { index } => write!(
                f,
                "NaN or infinite value at sample {index}; keep the samples where L, R, f and the generators are smooth"
            ),
        }
    }
}

impl core::error::Error for SampleError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_region_is_filled_evenly() {
        // Counts in the 16 cells of a 4×4 grid: 1000 points, 62.5 expected; independent points would spread by ±8.
        let mut cells = [0; 16];
        for q in region::<f64, 2>([0.0, 0.0], [4.0, 4.0], 1000) {
            cells[4 * q[0] as usize + q[1] as usize] += 1;
        }
        assert!(cells.iter().all(|&count| (56..=69).contains(&count)), "{cells:?}");
    }

    #[test]
    fn a_value_that_is_not_finite_is_named() {
        let segments = segments::<f64, 1>([0.0], [1.0], [0.1], 3);
        let worst = Worst::of(&segments, |index, _| if index == 1 { f64::NAN } else { 1.0 });
        assert_eq!(worst, Err(SampleError::NonFinite { index: 1 }));
        assert!(Worst::of(&segments, |_, _| 1.0).is_ok());
    }
}
