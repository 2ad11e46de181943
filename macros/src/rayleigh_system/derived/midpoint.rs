//! The midpoint rule's equation. With K = L + (h/2) R at q̄ = q0 + h v̄/2:
//!
//! ```text
//! p0, p1  = L_v − (h²/4) R_q ∓ (h/2) (L_q − R_v + f)
//! ∂p0/∂v̄  = K_vv + (h/2) K_vq − (h/2) (K_qv + f_v) − (h²/4) (K_qq + f_q)
//! ```

use std::collections::BTreeMap;

use super::directions::Along;
use super::kernel::{Equation, Parts};
use super::*;

impl Deriving<'_> {
    pub(super) fn midpoint(&mut self, parts: &Parts) -> Equation {
        let half = self.graph.half_step();
        let (negative, one) = (self.graph.negated(half), self.graph.one());
        let minus = Along { first: Some(negative), second: Some(one) };
        let plus = Along { first: Some(half), second: Some(one) };

        let modified = self.combined(&parts.lagrangian.hessian, half, &parts.rayleigh.hessian);
        let before = Derivatives { gradient: Gradient::new(), hessian: modified };
        let by_v: Vec<Vec<Node>> = parts.rows.iter().map(|row| self.along(row, plus)).collect();

        let [p0, p1] = self.momenta(half, parts);
        let matrix = self.by_velocity(&before, minus, plus, &by_v);
        Equation { p0, p1, matrix }
    }

    /// The derivative of ∂_direction (L + (h/2) R), with the force's share, by v̄: column by column.
    fn by_velocity(
        &mut self,
        of: &Derivatives,
        direction: Along,
        plus: Along,
        force_by_v: &[Vec<Node>],
    ) -> Vec<Node> {
        self.matrix(|deriving, i, j| {
            let entry = deriving.mixed(of, (i, direction), (j, plus));
            let force = force_by_v.get(i).map(|row| row[j]);
            match (force, direction.first) {
                (Some(force), Some(share)) if deriving.graph.constant_value(force) != Some(0.0) => {
                    let share = deriving.graph.times(share, force);
                    Some(deriving.added(entry, share))
                }
                _ => entry,
            }
        })
    }

    /// p0 and p1: half their sum and half their difference, each once.
    fn momenta(&mut self, half: Node, Parts { lagrangian, rayleigh, force, .. }: &Parts) -> [Vec<Node>; 2] {
        let (mut p0, mut p1) = (Vec::new(), Vec::new());
        let square = self.graph.times(half, half);
        for index in 0..self.n {
            let [coordinate, velocity] = [false, true].map(|velocity| self.variable(index, velocity));
            let of_rayleigh = |variable| rayleigh.gradient.get(&variable).copied();
            let shift = of_rayleigh(coordinate).map(|by_q| self.graph.times(square, by_q));
            let drag = of_rayleigh(velocity);
            let mean = self.difference(lagrangian.gradient.get(&velocity).copied(), shift);
            let of_force = force.get(index).copied();
            let acting = match (lagrangian.gradient.get(&coordinate).copied(), of_force) {
                (sum, Some(component)) => Some(self.added(sum, component)),
                (sum, None) => sum,
            };
            let acting = self.difference(acting, drag);
            let impulse = acting.map(|acting| self.graph.times(half, acting));
            let before = self.difference(mean, impulse);
            let after = match (mean, impulse) {
                (mean, Some(impulse)) => Some(self.added(mean, impulse)),
                (mean, None) => mean,
            };
            p0.push(self.or_zero(before));
            p1.push(self.or_zero(after));
        }
        [p0, p1]
    }

    /// a − b, where they are there.
    fn difference(&mut self, a: Option<Node>, b: Option<Node>) -> Option<Node> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.graph.minus(a, b)),
            (None, Some(b)) => Some(self.graph.negated(b)),
            (a, None) => a,
        }
    }

    /// a + factor × b.
    fn combined<K: Ord + Copy>(
        &mut self,
        a: &BTreeMap<K, Node>,
        factor: Node,
        b: &BTreeMap<K, Node>,
    ) -> BTreeMap<K, Node> {
        let mut total = a.clone();
        for (&key, &part) in b {
            let share = self.graph.times(factor, part);
            let entry = self.added(total.get(&key).copied(), share);
            total.insert(key, entry);
        }
        total
    }
}
