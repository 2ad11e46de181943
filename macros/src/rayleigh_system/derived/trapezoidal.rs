//! The trapezoidal rule's equation. With q1 = q0 + h v̄, and ⟨·⟩ the mean over q0 and q1:
//!
//! ```text
//! p0      = ⟨L_v⟩ + (h/2) ⟨R_v⟩ − (h/2) (L_q + f)(q0) − (h²/4) R_q(q0)
//! ∂p0/∂v̄  = ⟨L_vv⟩ + (h/2) ⟨R_vv⟩ − (h/2) f_v(q0) + (h/2) (L_vq(q1) − L_qv(q0)) + (h²/4) (R_vq(q1) − R_qv(q0))
//! p1      = ⟨L_v⟩ − (h/2) ⟨R_v⟩ + (h/2) (L_q + f)(q1) − (h²/4) R_q(q1)
//! ```

use super::super::graph::Point;
use super::kernel::{Equation, Parts};
use super::*;

impl Deriving<'_> {
    pub(super) fn trapezoidal(&mut self, parts: &Parts) -> Equation {
        let half = self.graph.half_step();
        let end_time = self.system.is_timed().then(|| self.graph.end_time());
        // The time at the start has the name that the bodies know.
        let [mut start, mut end] = [("q0", "start", None), ("q1", "end", end_time)]
            .map(|(q, name, time)| Point::new(name, self.coordinates(q, name), time));
        let (mut p0, mut p1) = (Vec::new(), Vec::new());
        for index in 0..self.n {
            let (v, q) = (self.variable(index, true), self.variable(index, false));
            let by_v = [&parts.lagrangian, &parts.rayleigh].map(|of| of.gradient.get(&v).copied());
            let by_q = [&parts.lagrangian, &parts.rayleigh].map(|of| of.gradient.get(&q).copied());
            let [l_v, r_v] = by_v.map(|entry| entry.map(|entry| self.mean(entry, &mut start, &mut end)));
            let r_v = r_v.map(|r_v| self.graph.times(half, r_v));
            let force = [by_q[0], parts.force.get(index).copied()];
            let force = force.into_iter().flatten().reduce(|a, b| self.graph.plus(a, b));
            let force = force.filter(|&force| self.graph.constant_value(force) != Some(0.0));
            let share = by_q[1].map(|r_q| self.graph.times(half, r_q));

            // (h/2) (L_q + f ± (h/2) R_q) at one end.
            let impulse = |deriving: &mut Self, end: &mut Point, share: Option<Node>| {
                let terms = [force, share].into_iter().flatten();
                let sum = terms.reduce(|a, b| deriving.graph.plus(a, b))?;
                let sum = deriving.graph.at(sum, end);
                Some(deriving.graph.times(half, sum))
            };
            let before = impulse(self, &mut start, share).map(|impulse| self.graph.negated(impulse));
            let negative = share.map(|share| self.graph.negated(share));
            let after = impulse(self, &mut end, negative);
            let drag = r_v.map(|r_v| self.graph.negated(r_v));
            for (momenta, terms) in [(&mut p0, [l_v, r_v, before]), (&mut p1, [l_v, drag, after])] {
                let sum = terms.into_iter().flatten().reduce(|a, b| self.graph.plus(a, b));
                momenta.push(self.or_zero(sum));
            }
        }
        let matrix = self.matrix(|deriving, i, j| {
            let mut sum = None;
            for (of, is_rayleigh) in [(&parts.lagrangian, false), (&parts.rayleigh, true)] {
                let second = deriving
                    .second(of, (i, true), (j, true))
                    .map(|entry| deriving.mean(entry, &mut start, &mut end));
                let ahead = deriving
                    .second(of, (i, true), (j, false))
                    .map(|entry| deriving.graph.at(entry, &mut end));
                let behind = deriving
                    .second(of, (i, false), (j, true))
                    .map(|entry| deriving.graph.at(entry, &mut start));
                let skew = match (ahead, behind) {
                    (Some(ahead), Some(behind)) if ahead == behind => None,
                    (Some(ahead), Some(behind)) => Some(deriving.graph.minus(ahead, behind)),
                    (None, Some(behind)) => Some(deriving.graph.negated(behind)),
                    (ahead, None) => ahead,
                };
                let skew = skew.map(|skew| deriving.graph.times(half, skew));
                let Some(own) = [second, skew].into_iter().flatten().reduce(|a, b| deriving.graph.plus(a, b))
                else {
                    continue;
                };
                let own = if is_rayleigh { deriving.graph.times(half, own) } else { own };
                sum = Some(deriving.added(sum, own));
            }
            let variable = deriving.variable(j, true);
            if let Some(&by_v) = parts.rows.get(i).and_then(|row| row.get(&variable)) {
                let by_v = deriving.graph.at(by_v, &mut start);
                let share = deriving.graph.times(half, by_v);
                let share = deriving.graph.negated(share);
                sum = Some(deriving.added(sum, share));
            }
            sum
        });
        Equation { p0, p1, matrix }
    }

    /// `q0[0]`, … as what is named after the place there.
    fn coordinates(&mut self, q: &str, place: &str) -> Vec<Node> {
        let entry = |index| {
            let entry = self.graph.entry(q, index);
            self.graph.give_name(entry, &format!("q{index}_{place}"));
            entry
        };
        (0..self.n).map(entry).collect()
    }

    /// The mean over both ends.
    fn mean(&mut self, node: Node, start: &mut Point, end: &mut Point) -> Node {
        let (a, b) = (self.graph.at(node, start), self.graph.at(node, end));
        if a == b {
            return a;
        }
        let sum = self.graph.plus(a, b);
        self.graph.scaled(0.5, sum)
    }
}
