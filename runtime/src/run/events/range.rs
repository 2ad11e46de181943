//! The range of event functions' values on a step: whether it is clear of 0.

use crate::numbers::Scalar;

/// By how much further from 0 values have to be that belong to the chord of a step: q and v are off there by
/// what a step changes of v.
pub(super) const BY_CHORD: f64 = 8.0;

/// By how many times half their range the values of a cubic have to be away from 0. A corner that touches 0
/// between its nodes, 0.577 of the step apart, makes the largest of four values 1.7 times the smallest.
pub(super) const BY_CUBIC: f64 = 6.0;

/// By how much the distance counts by which the cubic of a step, followed backwards, misses the values before
/// it. Its error goes as τ²(1 − τ)²: one step back 64 times the largest within.
const BY_MISS: f64 = 4.0;

/// As far from the values before a step as the cubic's `beyond`, and further.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn missed<S: Scalar, const K: usize>(earlier: &[S; K], beyond: [S; K]) -> [S; K] {
    let mut values = *earlier;
    for (value, beyond) in values.iter_mut().zip(beyond) {
        *value += (beyond - *value) * S::constant(BY_MISS);
    }
    values
}

/// The range of the values of some functions.
pub(super) struct Range<S, const K: usize> {
    low: [S; K],
    high: [S; K],
    /// NaN or infinite as soon as a value is.
    sum: S,
}

impl<S: Scalar, const K: usize> Range<S, K> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn of(values: [S; K]) -> Self {
        Self { low: values, high: values, sum: S::constant(0.0) }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn widen(&mut self, values: &[S; K]) {
        for ((low, high), &value) in self.low.iter_mut().zip(&mut self.high).zip(values) {
            // Neither keeps a NaN out: the sum does.
            if value < *low {
                *low = value
            }
            if value > *high {
                *high = value
            }
            self.sum += value;
        }
    }

    /// Whether all values are finite, and away from 0 by so many times half of their range.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn is_clear(&self, away: f64) -> bool {
        let away = S::constant(away);
        let is_clear = |(&low, &high): (&S, &S)| (low + high).widen().abs() > (away * (high - low)).widen();
        self.sum.widen().is_finite() && self.low.iter().zip(&self.high).all(is_clear)
    }
}
