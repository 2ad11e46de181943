//! Roots that rounding does not tell apart are one event: how the function passes there is what it is on both
//! sides of them.

use super::{CLEAR, EventError, Passage, Root, Roots, Search};

/// How far beyond the step the function is followed to where it is clear of 0, in shares of the step: one
/// that is not by then rests there.
const BEYOND: f64 = 1.0 / 1024.0;

/// Roots that are not further apart, in √ε of the step, may be one.
const NEAR: f64 = 4.0;

/// A function is larger at twice the distance from its root by more than this where it has no slope there: 4
/// times, with one twice.
const BENT: f64 = 3.0;

/// Where a function is clear of 0 on one side of a root.
#[derive(Clone, Copy)]
struct Side {
    /// Positive or negative; 0 where it is not known.
    value: f64,
    share: f64,
}

/// The roots of one step, and how the function goes into the next.
#[derive(Clone, Copy, Debug)]
pub(in crate::run::events) struct Settled {
    pub(in crate::run::events) roots: Roots,
    /// Whether the next step starts on an event that has been counted.
    pub(in crate::run::events) ends_there: bool,
    /// Of a function that rests at 0 a value from before; 0 of others.
    pub(in crate::run::events) before: f64,
}

impl Settled {
    /// A function that is 0 all along the step.
    pub(super) fn resting(before: f64) -> Self {
        Self { roots: Roots::new(), ends_there: true, before }
    }
}

impl Search<'_> {
    /// The events among the roots `found`, in order.
    pub(super) fn settle(&mut self, mut found: Roots) -> Result<Settled, EventError> {
        let near = NEAR * self.resolution;
        if self.curve.value(1.0)?.abs() <= CLEAR * self.curve.floor(1.0)? {
            match found.last_mut().filter(|last| last.to >= 1.0 - near) {
                Some(last) => (last.to, last.is_doubtful) = (1.0, true),
                None => found.push(Root::touching(1.0), self.curve)?,
            }
        }
        found.doubt(near);
        let mut settled = Settled { roots: Roots::new(), ends_there: false, before: 0.0 };
        let mut clear = Side { value: 0.0, share: 0.0 };
        if self.starts_there {
            clear = self.leaving(&found)?;
            if clear.value == 0.0 {
                return Ok(Settled::resting(self.before));
            }
            if self.before * clear.value < 0.0 {
                settled.roots.push(Root::passing(clear.share.min(1.0), clear.value), self.curve)?;
            }
            settled.ends_there = clear.share >= 1.0;
        }
        for root in found.iter() {
            let begins = if root.passage == Passage::Touching { root.from } else { root.share };
            if begins <= clear.share {
                // Of the start, or of the one before: after an impact the next, if it leads through the
                // surface.
                if root.to > clear.share {
                    let after = self.following(root.to)?;
                    if clear.value * after.value < 0.0 && self.came_from == 0.0 {
                        settled.roots.push(Root::passing(root.to.min(1.0), after.value), self.curve)?;
                    }
                    settled.ends_there |= after.share >= 1.0;
                    clear = after;
                }
                if settled.roots.count == 0 && self.starts_there && clear.value * self.came_from < 0.0 {
                    return Err(self.curve.too_many());
                }
                continue;
            }
            settled.ends_there = root.to >= 1.0 - near;
            if !root.is_doubtful {
                settled.roots.push(*root, self.curve)?;
                continue;
            }
            let (before, after) = (self.preceding(root.from, &clear)?, self.following(root.to)?);
            // What is 0 to the last digit is no root that rounding has widened.
            let rests =
                after.share - before.share > 2.0 * BEYOND && self.is_zero(before.share, after.share)?;
            let is_passed = before.value * after.value < 0.0;
            if rests || !is_passed {
                let share = if rests { before.share } else { root.share };
                settled.roots.push(Root::touching(share), self.curve)?;
            }
            if is_passed {
                let share = if rests { after.share.min(1.0) } else { root.share };
                settled.roots.push(Root::passing(share, after.value), self.curve)?;
            }
            settled.ends_there |= after.share >= 1.0;
            settled.before = if after.value == 0.0 { before.value } else { 0.0 };
            clear = after;
        }
        Ok(settled)
    }

    /// Where the function is clear of 0 after a start on it.
    fn leaving(&mut self, found: &Roots) -> Result<Side, EventError> {
        // After an impact from before the first root, be it close to the start.
        let first = found.iter().next().filter(|_| self.curve.is_restarted());
        let least = first.map_or(self.resolution, |root| root.share / 64.0);
        let side = self.side(0.0, least.clamp(4.0 * self.epsilon, self.resolution), 1.0 + BEYOND)?;
        let [near, far] = [side.share, 2.0 * side.share];
        if side.value * self.came_from < 0.0 && far <= 1.0 {
            // It goes on to the other side with no slope to carry it there: it presses against 0.
            if self.curve.value(far)? / self.curve.value(near)? > BENT {
                return Err(self.curve.too_many());
            }
        }
        Ok(side)
    }

    /// Where the function is clear of 0 before `from`, but not before it was `clear` last.
    fn preceding(&mut self, from: f64, clear: &Side) -> Result<Side, EventError> {
        let side = self.side(from, -self.resolution, clear.share)?;
        if side.value != 0.0 {
            return Ok(side);
        }
        let value = if clear.share == 0.0 { self.curve.value(0.0)? } else { clear.value };
        Ok(Side { value, share: clear.share })
    }

    /// Where the function is clear of 0 after `to`, a little beyond the step as well.
    fn following(&mut self, to: f64) -> Result<Side, EventError> {
        self.side(to, self.resolution, 1.0 + BEYOND)
    }

    /// Where the function is first found clear of 0, from `from` by `away` and ever more, before `limit`: the
    /// place to √ε.
    fn side(&mut self, from: f64, mut away: f64, limit: f64) -> Result<Side, EventError> {
        let mut last = from;
        loop {
            let share = if (from + away - limit) * away < 0.0 { from + away } else { limit };
            let Some(value) = self.clear(share)? else {
                if share == limit {
                    return Ok(Side { value: 0.0, share });
                }
                (last, away) = (share, 2.0 * away);
                continue;
            };
            let mut side = Side { value, share };
            while (side.share - last).abs() > 2.0 * self.resolution {
                let middle = 0.5 * (last + side.share);
                match self.clear(middle)? {
                    Some(value) => side = Side { value, share: middle },
                    None => last = middle,
                }
            }
            return Ok(side);
        }
    }

    /// The value at `share`, where it is clear of 0.
    fn clear(&mut self, share: f64) -> Result<Option<f64>, EventError> {
        let value = match self.curve.value(share) {
            // No step leads further.
            Err(_) if share > 1.0 => return Ok(None),
            value => value?,
        };
        Ok((value.abs() > CLEAR * self.curve.floor(share)?).then_some(value))
    }

    /// Whether the function is 0 between, and stays so when the state moves by a rounding.
    fn is_zero(&mut self, from: f64, to: f64) -> Result<bool, EventError> {
        let middle = 0.5 * (from + to);
        Ok(self.curve.value(middle)? == 0.0 && self.curve.floor(middle)? == 0.0)
    }
}

impl Root {
    /// One at which the function turns back, or rests.
    pub(super) fn touching(share: f64) -> Self {
        Self { share, passage: Passage::Touching, from: share, to: share, is_doubtful: true }
    }

    /// One after which the function has the sign of `after`.
    fn passing(share: f64, after: f64) -> Self {
        let passage = if after > 0.0 { Passage::Rising } else { Passage::Falling };
        Self { passage, ..Self::touching(share) }
    }
}
