//! All roots of an event function on one step, isolated and refined.
//!
//! The polynomial through values on the step that cost nothing decides where it can: with its error it is
//! held away from 0, or it is monotone there. A part where it cannot, near two roots or none, is asked for
//! true values, by partial steps, at ten nodes of its own, and so on with ever shorter parts, until signs
//! decide or a part is too short for them to.

mod cluster;
mod part;
mod refine;
mod settle;

use super::nodes::{MOST, Nodes};
use super::{Crossing, EventError};
use crate::rules::Gauss;
pub(super) use part::Origin;
use part::{Part, Verdict, Waiting, crosses};
pub(super) use settle::Settled;

/// An event function along one step, by shares of it: the ends are those of the grid.
pub(super) trait Curve {
    /// The value, by a partial step; at 0 exactly 0 where the step starts on the event.
    fn value(&mut self, share: f64) -> Result<f64, EventError>;

    /// Whether the run was restarted at this event.
    fn is_restarted(&self) -> bool;

    /// The rounding error of the value.
    fn floor(&mut self, share: f64) -> Result<f64, EventError>;

    /// More roots than are kept of one step.
    fn too_many(&self) -> EventError;

    /// Polynomials do not tell.
    fn unresolved(&self) -> EventError;
}

/// A root, and how the function passes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Root {
    pub(super) share: f64,
    pub(super) passage: Passage,
    /// Where it was found to lie: from here to there the function is 0 as far as is known.
    from: f64,
    to: f64,
    /// Whether rounding may have parted it from others, so that only its surroundings say how it is passed.
    is_doubtful: bool,
}

/// How an event function passes 0, in the direction in which the run goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passage {
    /// From below.
    Rising,
    /// From above.
    Falling,
    /// It touches 0 and turns back, passes twice so quickly that rounding does not tell (at two times that
    /// differ by less than √ε of the step), or comes to 0 and stays.
    Touching,
}

/// Roots kept of one step.
pub(super) const ROOTS: usize = 16;

/// Roots in order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Roots {
    list: [Root; ROOTS],
    count: usize,
}

impl Roots {
    pub(super) fn new() -> Self {
        Self { list: [Root::touching(0.0); ROOTS], count: 0 }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Root> {
        self.list.iter().take(self.count)
    }

    fn push(&mut self, root: Root, curve: &dyn Curve) -> Result<(), EventError> {
        *self.list.get_mut(self.count).ok_or_else(|| curve.too_many())? = root;
        self.count += 1;
        Ok(())
    }

    fn last_mut(&mut self) -> Option<&mut Root> {
        self.list.get_mut(self.count.checked_sub(1)?)
    }

    /// Doubts neighbours that are no further apart than `distance`.
    fn doubt(&mut self, distance: f64) {
        for index in 1..self.count {
            if let Some([one, other]) = self.list.get_mut(index - 1..=index)
                && other.from - one.to <= distance
            {
                (one.is_doubtful, other.is_doubtful) = (true, true);
            }
        }
    }
}

/// So many rounding errors away from 0 a function is clear of it: those of the state, and what the steps
/// before have added.
pub(super) const CLEAR: f64 = 8.0;

/// By how much polynomials may be further off than their last coefficients say: at times all of these are
/// small by chance. Of 420 000 random pairs of crossings close together 26 were missed at 1, 2 at 8, and at
/// 32 one of twice as many.
const DOUBT: f64 = 32.0;

/// By how much the slope of a cubic's error may be larger than the error, on [0, 1].
const STEEPER: f64 = 16.0;

/// An error below so many times what is clear of 0 is one of rounding.
const NOISE: f64 = 16.0;

/// The nodes of true values.
const OWN: Nodes = Nodes::new(&Gauss::<8>::NODES);

/// The search of a step for the roots of one event function.
pub(super) struct Search<'c> {
    pub(super) curve: &'c mut dyn Curve,
    /// Of the scalar.
    pub(super) epsilon: f64,
    /// Its root: below it an extremum is not told from its neighbourhood.
    pub(super) resolution: f64,
    /// Which crossings count: others are not refined.
    pub(super) crossing: Crossing,
    /// Whether the step starts on the event.
    pub(super) starts_there: bool,
    /// Of a function that has rested at 0 up to the step a value from before; 0 of others.
    pub(super) before: f64,
    /// The side of 0 from which the function came to where the run was restarted, as long as it has not left;
    /// else 0.
    pub(super) came_from: f64,
    /// By how much polynomials may be further off than they say.
    pub(super) caution: f64,
}

impl Search<'_> {
    /// The roots in (0, 1], from the `values` at `nodes` of the whole step, that the ends are among.
    ///
    /// A polynomial that proves wrong was trusted too far: then all are trusted less.
    pub(super) fn roots(
        &mut self,
        nodes: &Nodes,
        values: &[f64; MOST],
        origin: Origin,
    ) -> Result<Settled, EventError> {
        if values.iter().all(|value| *value == 0.0) {
            return Ok(Settled::resting(self.before));
        }
        for caution in [1.0, 8.0, 64.0] {
            self.caution = caution;
            if let Some(roots) = self.trusting(nodes, values, origin)? {
                return self.settle(roots);
            }
        }
        Err(self.curve.unresolved())
    }

    /// The roots, as far as polynomials are trusted now; `None` where one proves wrong.
    fn trusting(
        &mut self,
        nodes: &Nodes,
        values: &[f64; MOST],
        origin: Origin,
    ) -> Result<Option<Roots>, EventError> {
        let mut roots = Roots::new();
        let floor = self.curve.floor(0.0)?.max(self.curve.floor(1.0)?);
        let mut whole = self.part([0.0, 1.0], nodes, values, floor, origin);
        let mut verdict = self.judge(&whole);
        if matches!(verdict, Verdict::Nothing) {
            return Ok(Some(roots));
        }
        if let Origin::Cubic(_) = origin {
            // No error of the cubic, in q or in v, by its degree or as the rule is of order 2, is small at
            // both.
            let mut off = 0.0_f64;
            for share in [0.25, 0.7] {
                off = off.max((self.curve.value(share)? - whole.polynomial.value(share)).abs());
            }
            let error = 4.0 * off + 0.25 * whole.polynomial.bend();
            whole.error = self.caution * error + self.rounding(nodes, values) + CLEAR * floor;
            whole.slope_error = STEEPER * whole.error;
            verdict = self.judge(&whole);
        }
        if matches!(verdict, Verdict::Crossing) {
            return Ok(self.add(&whole, &mut roots)?.then_some(roots));
        }
        self.searched(whole, roots)
    }

    /// Adds the roots in `whole` to `roots`, part by part; `None` where a polynomial proves wrong.
    #[inline(never)]
    fn searched(&mut self, whole: Part, mut roots: Roots) -> Result<Option<Roots>, EventError> {
        let mut waiting = Waiting::of(whole);
        let mut cluster = None;
        while let Some(part) = waiting.pop() {
            match self.judge(&part) {
                Verdict::Nothing => self.close(&mut cluster, &mut roots)?,
                Verdict::Crossing => {
                    self.close(&mut cluster, &mut roots)?;
                    if !self.add(&part, &mut roots)? {
                        return Ok(None);
                    }
                }
                Verdict::Split(share) => {
                    let [left, right] = part.split(share);
                    waiting.push(right, self.curve)?;
                    waiting.push(left, self.curve)?;
                }
                Verdict::Unknown if self.is_short(&part)? => {
                    self.gather(&mut cluster, &part, &mut roots)?;
                }
                Verdict::Unknown => {
                    if !self.look(&mut waiting, &part)? {
                        return Ok(None);
                    }
                }
            }
        }
        self.close(&mut cluster, &mut roots)?;
        Ok(Some(roots))
    }

    /// Whether a part is too short to be told more of than its signs, or all its values are rounding. After a
    /// start on the event the slope of the function tells, as far as the share of the step has digits.
    fn is_short(&mut self, part: &Part) -> Result<bool, EventError> {
        let is_short = match self.starts_there {
            true if part.from == 0.0 => part.to <= 4.0 * self.epsilon,
            true => part.width() <= self.resolution * part.to,
            false => part.width() <= self.resolution,
        };
        if is_short || !part.is_true() {
            return Ok(is_short);
        }
        let [low, high] = part.polynomial.range();
        let (size, floor) = (low.abs().max(high), CLEAR * self.curve.floor(part.from + 0.5 * part.width())?);
        // Of rounding the polynomial makes its last coefficients, and of those its error.
        Ok(size <= floor || (size <= 2.0 * part.error && part.error <= NOISE * floor))
    }

    fn rounding(&self, nodes: &Nodes, values: &[f64; MOST]) -> f64 {
        let size = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        nodes.rounding(self.epsilon, size)
    }

    /// A part by `values` at its `nodes`, where rounding is `floor`.
    fn part(
        &self,
        [from, to]: [f64; 2],
        nodes: &Nodes,
        values: &[f64; MOST],
        floor: f64,
        origin: Origin,
    ) -> Part {
        let polynomial = nodes.polynomial(values);
        let [last, before, third] = nodes.tails(&polynomial).map(f64::abs);
        let degree = nodes.degree as f64;
        // By how much the slope may be off, in units of the value, on [0, 1].
        let (error, steeper) = match origin {
            Origin::Cubic(off) => (polynomial.bend() + off, STEEPER),
            // Beyond the last, each second coefficient is smaller by (z/n)², with 2z radians in a step.
            Origin::Stages => (DOUBT * (last + before + third * 4.0 / (degree * degree)), 4.0 * degree),
            Origin::Steps => (DOUBT * (last + before), 4.0 * degree),
        };
        let error = self.caution * error + self.rounding(nodes, values) + CLEAR * floor;
        let sampled = to - from;
        Part { from, to, polynomial, error, slope_error: steeper * error / sampled, sampled, origin }
    }

    /// Judges a part by its polynomial.
    fn judge(&self, part: &Part) -> Verdict {
        let Part { polynomial, error, .. } = part;
        let [low, high] = polynomial.range();
        if low > *error || high < -error {
            return Verdict::Nothing;
        }
        let [least, largest] = polynomial.slopes();
        let margin = part.slope_error * part.width();
        if least > margin || largest < -margin {
            return if crosses(polynomial.ends()) { Verdict::Crossing } else { Verdict::Nothing };
        }
        if low.abs().max(high) <= 2.0 * error || 64.0 * part.width() < part.sampled {
            return Verdict::Unknown;
        }
        let clear = |&share: &f64| polynomial.value(share).abs() > *error;
        let shares = if part.from == 0.0 { [0.5, 0.375, 0.4375] } else { [0.5, 0.375, 0.625] };
        shares.into_iter().find(clear).map_or(Verdict::Unknown, Verdict::Split)
    }

    /// Asks for true values on a part; on both its halves, where it has them. Whether its polynomial is as
    /// near to them as it says.
    fn look(&mut self, waiting: &mut Waiting, part: &Part) -> Result<bool, EventError> {
        if part.is_true() {
            let middle = part.from + 0.5 * part.width();
            let halves = [self.sampled(part.from, middle)?, self.sampled(middle, part.to)?];
            for (half, _) in halves.into_iter().rev() {
                waiting.push(half, self.curve)?;
            }
            return Ok(true);
        }
        let (looked, values) = self.sampled(part.from, part.to)?;
        waiting.push(looked, self.curve)?;
        let is_near =
            |(value, share): (&f64, &f64)| (value - part.polynomial.value(*share)).abs() <= 2.0 * part.error;
        Ok(values.iter().zip(&OWN.shares).all(is_near))
    }

    /// A part by true values.
    fn sampled(&mut self, from: f64, to: f64) -> Result<(Part, [f64; MOST]), EventError> {
        let mut values = [0.0; MOST];
        for (value, share) in values.iter_mut().zip(OWN.shares) {
            let at = if share == 1.0 { to } else { from + share * (to - from) };
            *value = self.curve.value(at)?;
        }
        let floor = self.curve.floor(to)?;
        Ok((self.part([from, to], &OWN, &values, floor, Origin::Steps), values))
    }
}
