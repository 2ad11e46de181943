//! Neighbouring parts that are too short to be told more of than their signs.

use super::part::{Origin, Part, crosses};
use super::{CLEAR, EventError, MOST, Root, Roots, Search};
use crate::run::events::nodes::Bernstein;

/// Neighbouring parts, each too short to be told more of than its signs.
#[derive(Clone, Copy)]
pub(super) struct Cluster {
    from: f64,
    to: f64,
    before: f64,
    after: f64,
    /// Where one of them comes as near to 0 as can be told.
    touching: Option<f64>,
}

/// Rounds of the search for where a function that bends comes nearest to 0: from √ε of the step to ε.
const ROUNDS: u32 = 40;

impl Search<'_> {
    /// Adds a part to the cluster that it continues.
    pub(super) fn gather(
        &mut self,
        cluster: &mut Option<Cluster>,
        part: &Part,
        roots: &mut Roots,
    ) -> Result<(), EventError> {
        let middle = part.from + 0.5 * part.width();
        let [before, between, after] =
            [self.curve.value(part.from)?, self.curve.value(middle)?, self.curve.value(part.to)?];
        if cluster.as_ref().is_some_and(|cluster| cluster.to != part.from) {
            self.close(cluster, roots)?;
        }
        let Part { from, to, .. } = *part;
        // The parabola through them, as the place of an extremum is known to √ε only, its value to all
        // digits.
        let bend = before - 2.0 * between + after;
        let vertex = between - (after - before) * (after - before) / (8.0 * bend);
        let size = before.abs().max(between.abs()).max(after.abs());
        let is_inside = (after - before).abs() <= 6.0 * bend.abs();
        let near = before.abs().min(between.abs()).min(after.abs());
        let touching =
            if (is_inside && vertex.abs() <= 1e-3 * size) || near <= CLEAR * self.curve.floor(middle)? {
                Some(middle)
            } else {
                self.bending(from, to)?
            };
        let gathered = cluster.get_or_insert(Cluster { from, to, before, after, touching });
        (gathered.to, gathered.after) = (to, after);
        gathered.touching = gathered.touching.or(touching);
        Ok(())
    }

    /// Where the function touches 0 at a corner between, by golden sections.
    fn bending(&mut self, mut from: f64, mut to: f64) -> Result<Option<f64>, EventError> {
        const SHARE: f64 = 0.381_966_011_250_105_1;
        let mut size = |share: f64| self.curve.value(share).map(f64::abs);
        let (mut left, mut right) = (from + SHARE * (to - from), to - SHARE * (to - from));
        let mut values = [size(from)?, size(left)?, size(right)?, size(to)?];
        for _ in 0..ROUNDS {
            let [start, one, other, end] = values;
            let least = start.min(one).min(other).min(end);
            if least > 2.0 * (start.max(end) - least) {
                // It is not steep enough to come to 0 between.
                break;
            }
            if one < other {
                (to, right) = (right, left);
                left = from + SHARE * (to - from);
                values = [start, size(left)?, one, other];
            } else {
                (from, left) = (left, right);
                right = to - SHARE * (to - from);
                values = [one, other, size(right)?, end];
            }
        }
        let middle = 0.5 * (from + to);
        let is_there = self.curve.value(middle)?.abs() <= CLEAR * self.curve.floor(middle)?;
        Ok(is_there.then_some(middle))
    }

    /// Decides on a cluster by the signs at its ends.
    pub(super) fn close(
        &mut self,
        cluster: &mut Option<Cluster>,
        roots: &mut Roots,
    ) -> Result<(), EventError> {
        let Some(Cluster { from, to, before, after, touching }) = cluster.take() else { return Ok(()) };
        if crosses([before, after]) {
            let mut values = [before; MOST];
            values[1] = after;
            let line = Bernstein { degree: 1, beta: values };
            let error = before.abs().max(after.abs());
            let part = Part {
                from,
                to,
                polynomial: line,
                error,
                slope_error: 0.0,
                sampled: to - from,
                origin: Origin::Steps,
            };
            return match self.refine(&part)? {
                Some(root) => roots.push(Root { from, to, is_doubtful: true, ..root }, self.curve),
                None => Ok(()),
            };
        }
        match touching.or((before == 0.0).then_some(from)) {
            Some(share) => roots.push(Root { from, to, ..Root::touching(share) }, self.curve),
            None => Ok(()),
        }
    }
}
