//! Neighbouring parts that are too short to be told more of than their signs.

use super::part::{Origin, Part, crosses};
use super::{EventError, MOST, Passage, Root, Roots, Search};
use crate::run::events::nodes::Bernstein;

/// Neighbouring parts, each too short to be told more of than its signs.
#[derive(Clone, Copy)]
pub(super) struct Cluster {
    from: f64,
    to: f64,
    before: f64,
    after: f64,
    /// Whether one of them comes as near to 0 as can be told.
    touches: bool,
}

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
        let touches = (is_inside && vertex.abs() <= 1e-3 * size)
            || before.abs().min(between.abs()).min(after.abs()) <= self.curve.floor(middle)?;
        let gathered = cluster.get_or_insert(Cluster { from, to, before, after, touches });
        (gathered.to, gathered.after) = (to, after);
        gathered.touches |= touches;
        Ok(())
    }

    /// Decides on a cluster by the signs at its ends.
    pub(super) fn close(
        &mut self,
        cluster: &mut Option<Cluster>,
        roots: &mut Roots,
    ) -> Result<(), EventError> {
        let Some(Cluster { from, to, before, after, touches }) = cluster.take() else { return Ok(()) };
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
                Some(root) => roots.push(root, self.curve),
                None => Ok(()),
            };
        }
        if from == 0.0 && before == 0.0 && self.curve.is_restarted() {
            // It happens again at once.
            return Err(self.curve.too_many());
        }
        // At the start it is the business of the step before.
        if from > 0.0 && touches {
            let middle = 0.5 * (from + to);
            let last = match roots.iter().last() {
                Some(Root { share, passage: Passage::Touching }) => Some(*share),
                None if self.starts_there => Some(0.0),
                _ => None,
            };
            if let Some(last) = last {
                let between = 0.5 * (last + middle);
                if self.curve.value(between)?.abs() <= 4.0 * self.curve.floor(between)? {
                    // The same, parted by rounding.
                    return Ok(());
                }
            }
            return roots.push(Root { share: middle, passage: Passage::Touching }, self.curve);
        }
        Ok(())
    }
}
