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

impl Code<'_> {
    pub(super) fn trapezoidal(&mut self, parts: &Parts) -> Equation {
        let half = self.graph.half_step();
        let end_time = self.system.is_timed().then(|| self.graph.written(quote!(t_end)));
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
            let impulse = |code: &mut Self, end: &mut Point, share: Option<Node>| {
                let terms = [force, share].into_iter().flatten();
                let sum = terms.reduce(|a, b| code.graph.plus(a, b))?;
                let sum = code.graph.at(sum, end);
                Some(code.graph.times(half, sum))
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
        let matrix = self.matrix(|code, i, j| {
            let mut sum = None;
            for (of, is_rayleigh) in [(&parts.lagrangian, false), (&parts.rayleigh, true)] {
                let second =
                    code.second(of, (i, true), (j, true)).map(|entry| code.mean(entry, &mut start, &mut end));
                let ahead =
                    code.second(of, (i, true), (j, false)).map(|entry| code.graph.at(entry, &mut end));
                let behind =
                    code.second(of, (i, false), (j, true)).map(|entry| code.graph.at(entry, &mut start));
                let skew = match (ahead, behind) {
                    (Some(ahead), Some(behind)) if ahead == behind => None,
                    (Some(ahead), Some(behind)) => Some(code.graph.minus(ahead, behind)),
                    (None, Some(behind)) => Some(code.graph.negated(behind)),
                    (ahead, None) => ahead,
                };
                let skew = skew.map(|skew| code.graph.times(half, skew));
                let Some(own) = [second, skew].into_iter().flatten().reduce(|a, b| code.graph.plus(a, b))
                else {
                    continue;
                };
                let own = if is_rayleigh { code.graph.times(half, own) } else { own };
                sum = Some(code.added(sum, own));
            }
            let variable = code.variable(j, true);
            if let Some(&by_v) = parts.rows.get(i).and_then(|row| row.get(&variable)) {
                let by_v = code.graph.at(by_v, &mut start);
                let share = code.graph.times(half, by_v);
                let share = code.graph.negated(share);
                sum = Some(code.added(sum, share));
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

    /// The code with h/2 and q1 in front, as far as it reads them.
    pub(super) fn at_both_ends(&self, line: &StraightLine, result: TokenStream) -> TokenStream {
        let half = line.uses("half").then(|| quote!(let half = 0.5 * h;));
        let q1 = line.uses("q1").then(|| {
            let index = (0..self.n).map(Literal::usize_unsuffixed);
            let entries = index.map(|index| quote!(q0[#index] + h * v[#index]));
            quote!(let q1 = [#(#entries),*];)
        });
        let t = line.uses("t").then(|| quote!(let t = self.t;));
        let t_end = line.uses("t_end").then(|| quote!(let t_end = self.t + h;));
        let given = of_segment([
            (q1.is_some() || line.uses("q0"), "q0"),
            (q1.is_some() || line.uses_velocities, "v"),
            (q1.is_some() || half.is_some() || t_end.is_some() || line.uses("h"), "h"),
        ]);
        let statements = &line.statements;
        quote! {
            #given
            #half
            #q1
            #t
            #t_end
            #statements
            #result
        }
    }
}
