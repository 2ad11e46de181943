//! Parts of a step, with the polynomial on each and what it may be off by.

use super::Curve;
use crate::run::events::EventError;
use crate::run::events::nodes::Bernstein;

/// Where values come from, which says how far a polynomial through them may be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::run::events) enum Origin {
    /// The cubic through (q, v) at both ends, which may be off by this, and more of a curve that it does not
    /// show: then a partial step says.
    Cubic(f64),
    /// The stages of a Gauss rule.
    Stages,
    /// Partial steps.
    Steps,
}

/// A part of the step with the polynomial on it.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) polynomial: Bernstein,
    /// How far the polynomial may be from the truth, and its slope by the share of the step.
    pub(super) error: f64,
    pub(super) slope_error: f64,
    /// How long the part was whose values made it.
    pub(super) sampled: f64,
    pub(super) origin: Origin,
}

impl Part {
    pub(super) fn width(&self) -> f64 {
        self.to - self.from
    }

    /// Whether it was itself asked for true values: then its ends are true.
    pub(super) fn is_true(&self) -> bool {
        self.origin == Origin::Steps && self.width() > 0.99 * self.sampled
    }

    /// The parts before and after `share` of it.
    pub(super) fn split(&self, share: f64) -> [Self; 2] {
        let middle = self.from + share * self.width();
        let [left, right] = self.polynomial.split(share);
        [Self { to: middle, polynomial: left, ..*self }, Self { from: middle, polynomial: right, ..*self }]
    }
}

/// The verdict on a part: how many roots it has, or how more is learnt of them.
pub(super) enum Verdict {
    /// No root.
    Nothing,
    /// One root.
    Crossing,
    /// More is known of the parts before and after this share.
    Split(f64),
    /// True values are needed.
    Unknown,
}

/// Whether a function crosses 0 in a half-open interval, from after its start to its end.
pub(super) fn crosses([start, end]: [f64; 2]) -> bool {
    (start < 0.0 && end >= 0.0) || (start > 0.0 && end <= 0.0)
}

/// The root of a monotone polynomial on [0, 1], and its slope there: Newton's method within a bracket.
pub(super) fn root(polynomial: &Bernstein) -> (f64, f64) {
    let [start, end] = polynomial.ends();
    let (mut low, mut high) = (0.0, 1.0);
    let mut at = start / (start - end);
    let mut slope = end - start;
    for _ in 0..40 {
        let value;
        [value, slope] = polynomial.value_and_slope(at);
        if value == 0.0 {
            break;
        }
        if (value < 0.0) == (end > start) {
            low = at
        } else {
            high = at
        }
        let mut next = at - value / slope;
        if !(next > low && next < high) {
            next = 0.5 * (low + high);
        }
        let correction = (next - at).abs();
        at = next;
        if correction < 1e-12 * at {
            break;
        }
    }
    (at, slope)
}

/// Parts that wait: each split leaves one, and shortens a part to five eighths at most, one at the start to
/// half; they are √ε of the step long at least, ε at the start.
const WAITING: usize = 64;

/// Parts that wait, the next one last.
pub(super) struct Waiting {
    parts: [Part; WAITING],
    count: usize,
}

impl Waiting {
    pub(super) fn of(part: Part) -> Self {
        Self { parts: [part; WAITING], count: 1 }
    }

    pub(super) fn push(&mut self, part: Part, curve: &dyn Curve) -> Result<(), EventError> {
        *self.parts.get_mut(self.count).ok_or_else(|| curve.too_many())? = part;
        self.count += 1;
        Ok(())
    }

    pub(super) fn pop(&mut self) -> Option<Part> {
        self.count = self.count.checked_sub(1)?;
        self.parts.get(self.count).copied()
    }
}
