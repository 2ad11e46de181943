//! The step's equation, fused: L, R and f with the rule's directions folded in, each shared expression once.
//!
//! With K = L + (h/2) R and K⁻ = L − (h/2) R at q̄ = q0 + h v̄/2:
//!
//! ```text
//! p0      = K_v − (h/2) (K_q + f)
//! ∂p0/∂v̄  = K_vv + (h/2) K_vq − (h/2) (K_qv + f_v) − (h²/4) (K_qq + f_q)
//! p1      = K⁻_v + (h/2) (K⁻_q + f)
//! ```

use std::collections::BTreeMap;

use super::directions::Along;
use super::*;

impl Code<'_> {
    /// `step_kernel` and `momenta` of a rule that sees each segment at one point; the others sum over their points.
    pub(super) fn kernel(
        &mut self,
        rule: Rule,
        lagrangian: Node,
        rayleigh: Option<Node>,
        force: Option<&[Node]>,
    ) -> Option<Kernel> {
        if rule != Rule::Midpoint {
            return None;
        }
        let half = self.graph.written(quote!(half));
        let (negative, one) = (self.graph.negated(half), self.graph.one());
        let minus = Along { first: Some(negative), second: Some(one) };
        let plus = Along { first: Some(half), second: Some(one) };

        let of_lagrangian = self.derivation.hessian(&mut self.graph, lagrangian, "l");
        let of_rayleigh =
            rayleigh.map(|root| self.derivation.hessian(&mut self.graph, root, "r")).unwrap_or_default();
        let before = self.modified(&of_lagrangian, half, &of_rayleigh);
        let after = self.modified(&of_lagrangian, negative, &of_rayleigh);
        let rows: Vec<Gradient> = force.map(|components| self.rows(components)).unwrap_or_default();
        let by_v: Vec<Vec<Node>> = rows.iter().map(|row| self.along(row, plus)).collect();

        let p0 = self.with_force(&before.gradient, minus, force);
        let p1 = self.with_force(&after.gradient, plus, force);
        let p0_by_v = self.by_velocity(&before, minus, plus, &by_v);

        let line = self.code_at_node(&[&p0[..], &p0_by_v].concat(), &[]);
        let [value, matrix] = self.parts(&line.outputs, [Shape::Vector, Shape::Matrix]);
        let step_kernel = self.at_midpoint(&line, quote!(StepKernel { p0: #value, matrix: #matrix }));

        let line = self.code_at_node(&[p0, p1].concat(), &[]);
        let [p0, p1] = self.parts(&line.outputs, [Shape::Vector, Shape::Vector]);
        let momenta = self.at_midpoint(&line, quote!(Momenta { p0: #p0, p1: #p1 }));
        Some(Kernel { step_kernel, momenta })
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
    fn with_force(&mut self, gradient: &Gradient, along: Along, force: Option<&[Node]>) -> Vec<Node> {
        let mut gradient = gradient.clone();
        for (index, &component) in force.unwrap_or_default().iter().enumerate() {
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
    fn at_midpoint(&self, line: &StraightLine, result: TokenStream) -> TokenStream {
        let uses_time = line.uses("t");
        let half =
            (line.uses_coordinates || line.uses("half") || uses_time).then(|| quote!(let half = 0.5 * h;));
        let t = uses_time.then(|| quote!(let t = self.t + half;));
        let q = line.uses_coordinates.then(|| {
            let index = (0..self.n).map(Literal::usize_unsuffixed);
            let entries = index.map(|index| quote!(q0[#index] + half * v[#index]));
            quote!(let q = [#(#entries),*];)
        });
        let mut unused = Vec::new();
        if q.is_none() {
            unused.push(quote!(q0));
        }
        if q.is_none() && !line.uses_velocities {
            unused.push(quote!(v));
        }
        if half.is_none() {
            unused.push(quote!(h));
        }
        let unused = (!unused.is_empty()).then(|| quote!(let _ = (#(#unused),*);));
        let statements = &line.statements;
        quote! {
            #unused
            #half
            #q
            #t
            #statements
            #result
        }
    }
}
