//! A crossing that was isolated, refined to rounding by partial steps.

use super::part::{Part, root};
use super::{Crossing, EventError, Passage, Root, Roots, Search};

/// Rounds of refinement at most: halving alone takes 52.
const ROUNDS: u32 = 120;

/// A root that rounding moves by less, in shares of the step, is no part of a double one: those move by √ε.
const STEEP: f64 = 1e-10;

impl Search<'_> {
    /// Adds the crossing on a part that has one, if it counts; whether the polynomial was right of it.
    pub(super) fn add(&mut self, part: &Part, roots: &mut Roots) -> Result<bool, EventError> {
        let [start, end] = part.polynomial.ends();
        if self.crossing == if end > start { Crossing::Falling } else { Crossing::Rising } {
            return Ok(true);
        }
        match self.refine(part)? {
            Some(root) => roots.push(root, self.curve).map(|()| true),
            None => Ok(false),
        }
    }

    /// The crossing on a part that has one, to rounding; `None` where the polynomial was wrong of it.
    ///
    /// From the polynomial's root by secants, within the bracket.
    pub(super) fn refine(&mut self, part: &Part) -> Result<Option<Root>, EventError> {
        let [start, end] = part.polynomial.ends();
        let rises = end > start;
        let passage = if rises { Passage::Rising } else { Passage::Falling };
        if end == 0.0 {
            return Ok(Some(Root { passage, ..Root::touching(part.to) }));
        }
        let verified = part.is_true();
        // Beside what the function is at the ends of the part; of single precision, more.
        let little = self.resolution.max(1e-6) * start.abs().max(end.abs());
        let (mut low, mut high) = (part.from, part.to);
        let (share, slope) = root(&part.polynomial);
        let mut at = part.from + share * part.width();
        let mut slope = slope / part.width();
        let mut last: Option<(f64, f64)> = None;
        let mut best = (f64::INFINITY, at);
        let mut shortest = high - low;
        for round in 0..ROUNDS {
            let value = self.curve.value(at)?;
            // The secants mend what is off by little.
            let allowed = (2.0 * part.error).max(little);
            if round == 0 && !verified && value.abs() > allowed {
                return Ok(None);
            }
            if value.abs() <= best.0 {
                best = (value.abs(), at);
            }
            // As far as rounding of the state tells.
            if value == 0.0 || (round > 0 && value.abs() <= 0.25 * self.curve.floor(at)?) {
                break;
            }
            if (value < 0.0) == rises {
                low = at
            } else {
                high = at
            }
            let mut moved = f64::INFINITY;
            if let Some((before, old)) = last {
                moved = (at - before).abs();
                if value != old {
                    slope = (value - old) / (at - before);
                }
            }
            last = Some((at, value));
            let unit = self.epsilon * at.abs();
            let mut next = at - value / slope;
            let correction = (next - at).abs();
            // Below rounding; or as small as noise, where it no longer shrinks.
            let is_noise = value.abs() <= little;
            if correction <= unit || (is_noise && moved <= self.resolution && correction > 0.25 * moved) {
                break;
            }
            let slow = round % 3 == 2 && high - low > 0.5 * shortest && correction > 0.5 * moved;
            if !(next > low && next < high) || slow {
                next = low + 0.5 * (high - low);
                if next <= low || next >= high {
                    break;
                }
            }
            if round % 3 == 2 {
                shortest = high - low;
            }
            at = next;
        }
        if best.0 > self.curve.floor(best.1)? && best.0 > little {
            // It jumps.
            best = (best.0, high);
        }
        // The bracket of a polynomial was one in truth if the root is not at an end of its own.
        let margin = 4.0 * self.epsilon * part.to;
        let after_start = best.1 > part.from + margin || part.from == 0.0;
        let before_end = best.1 < part.to - margin || part.to == 1.0;
        let trusted = verified || (after_start && before_end);
        let root = Root { passage, ..Root::touching(best.1) };
        if !trusted {
            return Ok(None);
        }
        // By the tangent, which has no second root within rounding where it is steep.
        let floor = self.curve.floor(best.1)?;
        let is_steep = floor > 0.0 && floor <= STEEP * slope.abs();
        Ok(Some(Root { is_doubtful: !is_steep, ..root }))
    }
}
