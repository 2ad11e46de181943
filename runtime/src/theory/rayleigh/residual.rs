//! Integrals that have to vanish.

use core::fmt;

use super::Integral;
use crate::theory::{
    samples::{Pair, SampleError},
    verdict::{Finding, Tolerance},
};

/// A quantity that has to vanish, over the samples. A tolerance that the quadrature's error brings up to the
/// size of the terms says nothing.
pub type SegmentFinding<const N: usize> = Finding<Pair<f64, N>>;

/// Keeps the value that is worse in units of its tolerance; what a tolerance says nothing of is worst.
pub(super) fn keep_worse<const N: usize>(
    worst: &mut Option<SegmentFinding<N>>,
    value: f64,
    tolerance: f64,
    terms: f64,
    at: Pair<f64, N>,
) {
    SegmentFinding::bounded(value, tolerance, terms, at)
        .keep_if_worse(worst, SegmentFinding::excess_or_silence);
}

/// Keeps a `gap` between integrals that is worse, at the sample `index`.
pub(super) fn keep_worse_gap<const N: usize>(
    worst: &mut Option<SegmentFinding<N>>,
    gap: Integral,
    relative: f64,
    index: usize,
    at: Pair<f64, N>,
) -> Result<(), SampleError> {
    let tolerance = gap.error + relative * gap.magnitude;
    if !(gap.value.is_finite() && tolerance.is_finite()) {
        return Err(SampleError::NonFinite { index });
    }
    keep_worse(worst, gap.value, tolerance, gap.magnitude, at);
    Ok(())
}

/// Relative size of what counts as rounding, for reports.
pub(super) fn rounding_note(f: &mut fmt::Formatter<'_>, relative: f64) -> fmt::Result {
    write!(
        f,
        "  tolerances: {relative:.1e} ({} ε) of the terms, and the quadrature's error",
        Tolerance::ROUNDINGS
    )
}
