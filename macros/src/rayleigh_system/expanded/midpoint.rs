//! The midpoint rule's equation. With K = L + (h/2) R and K⁻ = L − (h/2) R at q̄ = q0 + h v̄/2:
//!
//! ```text
//! p0      = K_v − (h/2) (K_q + f)
//! ∂p0/∂v̄  = K_vv + (h/2) K_vq − (h/2) (K_qv + f_v) − (h²/4) (K_qq + f_q)
//! p1      = K⁻_v + (h/2) (K⁻_q + f)
//! ```

use std::collections::BTreeMap;

use super::directions::Along;
use super::kernel::{Equation, Parts};
use super::*;

impl Code<'_> {
    pub(super) fn midpoint(&mut self, parts: &Parts) -> Equation {
        let half = self.graph.written(quote!(half));
        let (negative, one) = (self.graph.negated(half), self.graph.one());
        let minus = Along { first: Some(negative), second: Some(one) };
        let plus = Along { first: Some(half), second: Some(one) };

        let before = self.modified(&parts.lagrangian, half, &parts.rayleigh);
        let after = self.modified(&parts.lagrangian, negative, &parts.rayleigh);
        let by_v: Vec<Vec<Node>> = parts.rows.iter().map(|row| self.along(row, plus)).collect();

        let p0 = self.with_force(&before.gradient, minus, &parts.force);
        let p1 = self.with_force(&after.gradient, plus, &parts.force);
        let matrix = self.by_velocity(&before, minus, plus, &by_v);
        Equation { p0, p1, matrix }
    }

    /// L ± (h/2) R.
    fn modified(&mut self, lagrangian: &Derivatives, share: Node, rayleigh: &Derivatives) -> Derivatives {
        Derivatives {
            gradient: self.combined(&lagrangian.gradient, share, &rayleigh.gradient),
            hessian: self.combined(&lagrangian.hessian, share, &rayleigh.hessian),
        }
    }

    /// The derivative of ∂_direction (L ± (h/2) R), with the force's share, by v̄: column by column.
    fn by_velocity(
        &mut self,
        of: &Derivatives,
        direction: Along,
        plus: Along,
        force_by_v: &[Vec<Node>],
    ) -> Vec<Node> {
        self.matrix(|code, i, j| {
            let entry = code.mixed(of, (i, direction), (j, plus));
            let force = force_by_v.get(i).map(|row| row[j]);
            match (force, direction.first) {
                (Some(force), Some(share)) if code.graph.constant_value(force) != Some(0.0) => {
                    let share = code.graph.times(share, force);
                    Some(code.added(entry, share))
                }
                _ => entry,
            }
        })
    }

    /// K_v + first (K_q + f).
    fn with_force(&mut self, gradient: &Gradient, along: Along, force: &[Node]) -> Vec<Node> {
        let mut gradient = gradient.clone();
        for (index, &component) in force.iter().enumerate() {
            let variable = self.variable(index, false);
            let sum = self.added(gradient.get(&variable).copied(), component);
            gradient.insert(variable, sum);
        }
        self.along(&gradient, along)
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

    /// The code with h/2 and q̄ in front, as far as it reads them.
    pub(super) fn at_midpoint(&self, line: &StraightLine, result: TokenStream) -> TokenStream {
        let half = (line.uses_coordinates || line.uses("half")).then(|| quote!(let half = 0.5 * h;));
        let q = line.uses_coordinates.then(|| {
            let index = (0..self.n).map(Literal::usize_unsuffixed);
            let entries = index.map(|index| quote!(q0[#index] + half * v[#index]));
            quote!(let q = [#(#entries),*];)
        });
        let unused =
            unused([(q.is_some(), "q0"), (q.is_some() || line.uses_velocities, "v"), (half.is_some(), "h")]);
        let statements = &line.statements;
        quote! {
            #unused
            #half
            #q
            #statements
            #result
        }
    }
}
