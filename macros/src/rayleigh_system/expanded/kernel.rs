//! The step's equation, fused: L, R and f with the rule's directions folded in, each shared expression once.
//!
//! With K = L + (h/2) R at q̄ = q0 + h v̄/2:
//!
//! ```text
//! p0      = K_v − (h/2) (K_q + f)
//! ∂p0/∂v̄  = K_vv + (h/2) K_vq − (h/2) (K_qv + f_v) − (h²/4) (K_qq + f_q)
//! p1      = K⁻_v + (h/2) (K⁻_q + f)                                           K⁻ = L − (h/2) R
//! ```

use super::directions::Along;
use super::*;
use crate::rayleigh_system::expand::Kernel;

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

        let (modified, symbol) = match rayleigh {
            Some(rayleigh) => {
                let share = self.graph.times(half, rayleigh);
                (self.graph.plus(lagrangian, share), "k")
            }
            None => (lagrangian, "l"),
        };
        let of = self.derivation.hessian(&mut self.graph, modified, symbol);
        let by_v: Option<Vec<Vec<Node>>> = force.map(|components| {
            let rows = self.rows(components);
            rows.iter().map(|row| self.along(row, plus)).collect()
        });
        let p0 = self.with_force(&of.gradient, minus, force);
        let matrix = self.matrix(|code, i, j| {
            let entry = code.mixed(&of, (i, minus), (j, plus));
            match by_v.as_ref().map(|by_v| by_v[i][j]) {
                Some(by_v) if code.graph.constant_value(by_v) != Some(0.0) => {
                    let share = code.graph.times(negative, by_v);
                    Some(code.added(entry, share))
                }
                _ => entry,
            }
        });
        let line = self.code(&[p0, matrix].concat());
        let [p0, matrix] = self.parts(&line.outputs, [Shape::Vector, Shape::Matrix]);
        let step_kernel = self.at_midpoint(&line, quote!(StepKernel { p0: #p0, matrix: #matrix }));

        let plain = self.derivation.gradient(&mut self.graph, lagrangian);
        let dissipative =
            rayleigh.map(|rayleigh| self.derivation.gradient(&mut self.graph, rayleigh)).unwrap_or_default();
        let before = self.combined(&plain, half, &dissipative);
        let after = self.combined(&plain, negative, &dissipative);
        let outputs = [self.with_force(&before, minus, force), self.with_force(&after, plus, force)];
        let line = self.code(&outputs.concat());
        let [p0, p1] = self.parts(&line.outputs, [Shape::Vector, Shape::Vector]);
        let momenta = self.at_midpoint(&line, quote!(Momenta { p0: #p0, p1: #p1 }));
        Some(Kernel { step_kernel, momenta })
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
    fn combined(&mut self, a: &Gradient, factor: Node, b: &Gradient) -> Gradient {
        let mut total = a.clone();
        for (&variable, &part) in b {
            let share = self.graph.times(factor, part);
            let entry = self.added(total.get(&variable).copied(), share);
            total.insert(variable, entry);
        }
        total
    }

    /// The code with h/2 and q̄ in front, as far as it reads them.
    fn at_midpoint(&self, line: &StraightLine, result: TokenStream) -> TokenStream {
        let half = (line.uses_coordinates || line.uses("half")).then(|| quote!(let half = 0.5 * h;));
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
            #statements
            #result
        }
    }
}
