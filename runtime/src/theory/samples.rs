//! Where the checkers look: segments (q0, q1) of Q×Q, points of a region, and the worst of what was found
//! there ([`Finding`]).
//!
//! A checker's verdict is about the points that it was given. Points of a region, spread evenly by [`region`]
//! and [`segments`], speak for the region; those of one trajectory ([`Pair::along`]) for that trajectory
//! alone.
//!
//! Of a system at a time t0, a view, the k-th segment starts at t0 + k h: the segments of a trajectory each
//! at its own time, those of a region at times spread over as many steps.
//!
//! **Samples that cannot tell.** No verdict is given on samples that prove nothing: a NaN or an infinity is a
//! [`SampleError`], and so are samples that cannot tell yes from no. One rule holds for every checker:
//!
//! ```text
//! a segment moves            by more than 10 τ of its coordinates, τ = 1024 ε
//! two samples lie apart      by more than √τ of the size of a coordinate
//! a view is asked            at three times at least, a step each after the other
//! a tolerance                leaves a digit of what it is held against
//! ```
//!
//! Nearer than √τ a quantity whose slope is 0 changes by less than what counts as zero. Checkers that claim
//! one constant for all samples ask for samples that lie apart. They also ask at samples that they make of
//! those given, so that neither a symmetry between two of them nor a line through all hides what changes.

mod apart;
mod error;

use core::fmt;
use std::borrow::Cow;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::Discretised;
use crate::system::{Lagrangian, is_timed};
pub use crate::theory::verdict::{Finding, Tolerance, Verdict};
pub(crate) use apart::{Sizes, around, different};
pub(crate) use error::STOPPED;
pub use error::SampleError;

/// A pair (q0, q1) of configurations, a point of Q×Q: the two ends of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair<S, const N: usize> {
    /// Configuration at the start.
    pub q0: SVector<S, N>,
    /// Configuration at the end.
    pub q1: SVector<S, N>,
}

impl<S: Scalar, const N: usize> Pair<S, N> {
    /// The pair (q0, q1).
    pub fn new(q0: impl Into<SVector<S, N>>, q1: impl Into<SVector<S, N>>) -> Self {
        Self { q0: q0.into(), q1: q1.into() }
    }

    /// The pairs of a discrete path q₀, q₁, q₂, …, such as the configurations of a trajectory.
    #[must_use]
    pub fn along(path: &[SVector<S, N>]) -> Vec<Self> {
        path.windows(2).map(|pair| Self { q0: pair[0], q1: pair[1] }).collect()
    }

    /// Whether it leads anywhere: one at rest says nothing of what depends on velocities, nor does one whose
    /// squares underflow, or whose displacement is rounding of the coordinates.
    pub(crate) fn moves(&self) -> bool {
        let by = self.q1 - self.q0;
        let is_more_than_rounding = |i: usize| {
            let size = self.q0[i].widen().abs().max(self.q1[i].widen().abs());
            // A NaN is an error of its own.
            !Tolerance { relative: Tolerance::rounding::<S>(), scale: size }.hides(by[i].widen())
        };
        is_felt(&by) && (0..N).any(is_more_than_rounding)
    }

    /// This pair in `f64`.
    pub(crate) fn widen(&self) -> Pair<f64, N> {
        Pair { q0: self.q0.map(Scalar::widen), q1: self.q1.map(Scalar::widen) }
    }
}

impl<S: fmt::Display, const N: usize> fmt::Display for Pair<S, N> {
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

/// `count` points spread evenly over the box from `low` to `high`: the additive sequence with the ratios g⁻¹,
/// g⁻², …, g the positive root of x^{N+1} = x + 1 (the generalised golden ratio; Roberts, 2018).
///
/// They are the same points each time, so that a verdict can be repeated.
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
) -> Vec<Pair<S, N>> {
    let (low, high, reach) = (low.into(), high.into(), reach.into());
    let ratios = Ratios::new(2 * N);
    (0..count)
        .map(|k| {
            let share = |i| S::constant(ratios.share(k, i));
            let q0 = SVector::from_fn(|i, _| low[i] + (high[i] - low[i]) * share(i));
            let both_ways = |i| share(N + i) * S::constant(2.0) - S::one();
            Pair { q0, q1: SVector::from_fn(|i, _| q0[i] + reach[i] * both_ways(i)) }
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
struct Ratios(Vec<f64>);

impl Ratios {
    fn new(dimensions: usize) -> Self {
        // The fixed point of x = (1 + x)^{1/(d+1)}: the map contracts by less than ½, 64 iterations are
        // plenty.
        let exponent = 1.0 / (dimensions as f64 + 1.0);
        let g = (0..64).fold(1.5_f64, |g, _| (1.0 + g).powf(exponent));
        Self((0..dimensions).map(|axis| g.powf(-(axis as f64 + 1.0))).collect())
    }

    /// Coordinate `axis` of point `k`, in [0, 1).
    fn share(&self, k: usize, axis: usize) -> f64 {
        (0.5 + (k as f64 + 1.0) * self.0[axis]).fract()
    }
}

/// Whether some entry has a square that is a normal number. What is not finite is an error of its own.
pub(crate) fn is_felt<S: Scalar, const N: usize>(vector: &SVector<S, N>) -> bool {
    vector.iter().any(|entry| *entry * *entry >= S::SMALLEST_NORMAL || !entry.is_finite())
}

/// The caller has ended the check.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stopped;

/// `evaluate` of a discretised system at the start of the k-th segment, k h after its own time, unless the
/// caller ends the check: checkers go from sample to sample by this function, and ask here alone.
pub(crate) fn at_segment<L: Lagrangian<N>, R, T, const N: usize>(
    by: &Discretised<'_, L, R, N>,
    k: usize,
    evaluate: impl FnOnce(&Discretised<'_, L, R, N>) -> T,
) -> Result<T, Stopped> {
    if by.stop.is_asked() { Err(Stopped) } else { Ok(at_time_of(by, k, evaluate)) }
}

/// `evaluate` of a discretised system at the start of the k-th segment, whatever the caller says: of a sample
/// that is looked at already.
pub(crate) fn at_time_of<L: Lagrangian<N>, R, T, const N: usize>(
    by: &Discretised<'_, L, R, N>,
    k: usize,
    evaluate: impl FnOnce(&Discretised<'_, L, R, N>) -> T,
) -> T {
    // The time of a trajectory after k steps, bit by bit.
    let time = L::Scalar::constant(by.h.widen() * k as f64);
    by.system.later(time, |system| evaluate(&by.of(system)))
}

/// Times at which a view is asked, at least.
const TIMES: usize = 3;

/// The segments, those of a view again and again until there is one for each of three times.
pub(crate) fn at_several_times<'s, L: Lagrangian<N>, R, const N: usize>(
    by: &Discretised<'_, L, R, N>,
    segments: &'s [Pair<L::Scalar, N>],
) -> Cow<'s, [Pair<L::Scalar, N>]> {
    if segments.len() < TIMES && is_timed(by.system) {
        segments.iter().cycle().take(if segments.is_empty() { 0 } else { TIMES }).copied().collect()
    } else {
        Cow::Borrowed(segments)
    }
}

/// Fails on a step size that no verdict can be given for: with one below the normal numbers, forces underflow
/// to an exact 0.
pub(crate) fn require_step_size<S: Scalar>(h: S) -> Result<(), SampleError> {
    let size = h.widen().abs();
    if size >= S::SMALLEST_NORMAL.widen() && size.is_finite() { Ok(()) } else { Err(SampleError::StepSize) }
}

/// Fails where no segment says anything.
pub(crate) fn require_informative<S: Scalar, const N: usize>(
    segments: &[Pair<S, N>],
    says_something: impl Fn(&Pair<S, N>) -> bool,
) -> Result<(), SampleError> {
    if segments.is_empty() {
        return Err(SampleError::TooFew { given: 0, needed: 1 });
    }
    // What is not finite is an error of its own, named where it is met.
    let finite = |segment: &Pair<S, N>| segment.q0.iter().chain(&segment.q1).all(|entry| entry.is_finite());
    if segments.iter().any(|segment| !finite(segment) || says_something(segment)) {
        Ok(())
    } else {
        Err(SampleError::Uninformative { given: segments.len() })
    }
}

/// The value of a quantity that is furthest above its tolerance over the samples, `relative` × its scale. All
/// have to be finite.
pub(crate) fn worst<S: Scalar, const N: usize>(
    segments: &[Pair<S, N>],
    relative: f64,
    scales: &[f64],
    mut value: impl FnMut(usize) -> f64,
) -> Result<Finding<Pair<f64, N>>, SampleError> {
    let mut worst = None;
    for (index, (segment, &scale)) in segments.iter().zip(scales).enumerate() {
        let value = value(index);
        if !(value.is_finite() && scale.is_finite()) {
            return Err(SampleError::NonFinite { index });
        }
        let finding = Finding::relative(value, Tolerance { relative, scale }, segment.widen());
        finding.keep_if_worse(&mut worst, Finding::excess);
    }
    worst.ok_or(SampleError::TooFew { given: 0, needed: 1 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_region_is_filled_evenly() {
        // Counts in the 16 cells of a 4×4 grid: 1000 points, 62.5 expected; independent points would spread
        // by ±8.
        let mut cells = [0; 16];
        for q in region::<f64, 2>([0.0, 0.0], [4.0, 4.0], 1000) {
            cells[4 * q[0] as usize + q[1] as usize] += 1;
        }
        assert!(cells.iter().all(|&count| (56..=69).contains(&count)), "{cells:?}");
    }

    #[test]
    fn a_value_that_is_not_finite_is_named() {
        let segments = segments::<f64, 1>([0.0], [1.0], [0.1], 3);
        let of = |scales: &[f64], value: f64| {
            worst(&segments, 1e-3, scales, |index| if index == 1 { value } else { 1.0 })
        };
        for poison in [f64::NAN, f64::INFINITY] {
            assert_eq!(of(&[1.0; 3], poison), Err(SampleError::NonFinite { index: 1 }));
            assert_eq!(of(&[1.0, 1.0, poison], 1.0), Err(SampleError::NonFinite { index: 2 }));
        }
        assert_eq!(of(&[1.0; 3], 2.0).unwrap().value, 2.0);
        // The furthest above its own tolerance, not the largest.
        assert_eq!(of(&[10.0, 1e9, 1.0], 2.0).unwrap().at, segments[2]);
    }
}
