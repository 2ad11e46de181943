//! The equations of motion at the stages of a Gauss rule, in lanes: L, R and f together, each shared
//! expression once.
//!
//! ```text
//! G = ∂L/∂q − ∂R/∂v + f,   residual = P − ∂L/∂v,   correction = (∂²L/∂v²)⁻¹ residual
//! ```
//!
//! The matrix is factored here, M = L D Lᵀ without exchanges, so that its zeros and constants cost nothing. A
//! pivot that is 0 makes the correction infinite, and the runtime takes Newton's method.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use std::collections::BTreeSet;

use super::super::emit::{Anchored, inlined_on_lanes, number_of_stages};
use super::in_lanes::tuple;
use super::*;

/// `stages`, and the functions of several members at once where they are asked for.
#[derive(Default)]
pub(super) struct StagesWritten {
    pub(super) function: Option<TokenStream>,
    /// Why they are not written, if they were to be.
    pub(super) lacks: Option<&'static str>,
}

impl StagesWritten {
    fn lacking(why: &'static str) -> Self {
        Self { lacks: Some(why), ..Self::default() }
    }
}

/// The parameter by which code in sweeps keeps angles and reciprocals from one sweep to the next.
pub(super) struct Anchors {
    pub(super) ty: TokenStream,
    /// The name of the parameter.
    pub(super) parameter: Ident,
    /// `let (angles, reciprocals) = anchors;`
    pub(super) apart: Option<TokenStream>,
}

impl Anchors {
    /// Of values of the type `lanes`.
    pub(super) fn new(line: &StraightLine, lanes: &TokenStream, is_fused: bool) -> Self {
        let fused = is_fused.then(|| quote!(, true));
        let groups: Vec<_> = [("Angle", "angles"), ("Reciprocal", "reciprocals")]
            .into_iter()
            .zip(line.anchors)
            .filter(|&(_, count)| count > 0)
            .map(|((ty, name), count)| {
                let (ty, name, count) =
                    (format_ident!("{ty}"), format_ident!("{name}"), Literal::usize_unsuffixed(count));
                (quote!([::dalembert::generated::#ty<#lanes #fused>; #count]), name)
            })
            .collect();
        let ty = tuple(groups.iter().map(|(ty, _)| ty.clone()));
        match &groups[..] {
            [(_, name)] => Self { ty, parameter: name.clone(), apart: None },
            groups => {
                let names = tuple(groups.iter().map(|(_, name)| quote!(#name)));
                let apart = (!groups.is_empty()).then(|| quote!(let #names = anchors;));
                Self { ty, parameter: parameter("anchors", apart.is_some()), apart }
            }
        }
    }
}

const NOT_FACTORED: &str =
    "needs ∂²L/∂v² factored without exchanges, and a pivot is 0 by structure, or the matrix is too large";

pub const CONDITIONAL: &str = "reads all fields before the run, and a body reads one within a condition, where it may panic; read it before the condition";

/// Longer factorisations are left to the runtime.
const MAX_PRODUCTS: usize = 4000;

impl Code<'_> {
    /// `stages`, or the reason why they are left to the runtime.
    pub(super) fn stages(
        &mut self,
        lagrangian: Node,
        rayleigh: Option<Node>,
        force: Option<&[Node]>,
    ) -> Written<StagesWritten> {
        let of_lagrangian = self.derivation.hessian(&mut self.graph, lagrangian, "l");
        let rates = self.rates(&of_lagrangian.gradient, rayleigh, force);
        let momenta = self.covector(&of_lagrangian.gradient, true);
        // What the closure returns is known after the rates.
        let late: Vec<Node> = (0..self.n).map(|index| self.graph.entry("p", index)).collect();
        let residuals: Vec<Node> = late
            .iter()
            .zip(momenta)
            .enumerate()
            .map(|(index, (&p, momentum))| {
                let residual = self.graph.minus(p, momentum);
                self.graph.give_name(residual, &format!("residual{index}"));
                residual
            })
            .collect();
        let Some(corrections) = self.solved(&of_lagrangian, &residuals) else {
            return Ok(StagesWritten::lacking(NOT_FACTORED));
        };

        let outputs = [rates, residuals, corrections].concat();
        self.complete()?;
        let outputs = self.graph.with_fewer_angles(&outputs);
        let outputs = self.rounded(&outputs)?;
        // Lanes take both ways of a selection.
        if self.graph.is_conditional(outputs.iter().copied()) {
            return Ok(StagesWritten::lacking(CONDITIONAL));
        }
        let reciprocals = self.of_corrections_alone(&outputs);
        let anchored = Anchored(&reciprocals);
        if self.system.lanes.gauss.is_some() {
            self.in_lanes.stages = Some(self.stage_lines(&outputs, &late, anchored));
        }
        let mut taken = vec!["q", "v", "p", "rate", "momenta", "anchors", "angles", "reciprocals"];
        if self.system.home() == Home::View {
            taken.extend(["u", "t", "elapsed"]);
        }
        let mut line = self.writing(&taken).lanes(&outputs, &late, anchored);
        if self.system.home() == Home::View {
            let seen = |tokens: TokenStream| view::seen_from_view(tokens, &self.system.name);
            let input = line.uses_inputs.then(|| quote!(let u = self.u;));
            let time = line.uses("t").then(|| quote!(let t = *elapsed + self.t;));
            let statements = seen(line.statements);
            line.statements = quote!(#input #time #statements);
            line.later = seen(line.later);
            line.outputs = line.outputs.into_iter().map(seen).collect();
        }
        self.calls_elementary |= line.calls_elementary;
        let (rates, rest) = line.outputs.split_at(self.n);
        let (residuals, corrections) = rest.split_at(self.n);
        let (scalar, n) = (&self.system.scalar, self.system.degrees.times(1));
        let (q, v) = (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities));
        let (statements, later, stages) = (&line.statements, &line.later, number_of_stages(&self.graph));
        let (function, text, elapsed) = if self.system.timed.any() {
            let elapsed = parameter("elapsed", line.uses("t"));
            let text = " G, P − ∂L/∂v and (∂²L/∂v²)⁻¹ (P − ∂L/∂v) at all stages, each at its own time.";
            (format_ident!("stages_in_time"), text, Some(quote!(#elapsed: &Lanes<#scalar, #stages>,)))
        } else {
            (format_ident!("stages"), " G, P − ∂L/∂v and (∂²L/∂v²)⁻¹ (P − ∂L/∂v) at all stages.", None)
        };
        let lanes = quote!(Lanes<#scalar, #stages>);
        let Anchors { ty, parameter: anchors, apart } =
            Anchors::new(&line, &lanes, self.system.fused.is_some());
        let inline = inlined_on_lanes(&quote!(#statements #later));
        let function = quote! {
            type Anchors<const #stages: usize> = #ty;

            #[doc = #text]
            #inline
            fn #function<const #stages: usize>(
                &self,
                #anchors: &mut Self::Anchors<#stages>,
                #elapsed
                #q: &LaneVector<#scalar, #n, #stages>,
                #v: &LaneVector<#scalar, #n, #stages>,
                momenta: impl FnOnce(&LaneVector<#scalar, #n, #stages>) -> LaneVector<#scalar, #n, #stages>,
            ) -> Stages<#scalar, #n, #stages> {
                #apart
                #statements
                let rate = [#(#rates),*];
                let p = momenta(&rate);
                #later
                Stages { rate, residual: [#(#residuals),*], correction: [#(#corrections),*] }
            }
        };
        Ok(StagesWritten { function: Some(function), lacks: None })
    }

    /// G = ∂L/∂q − ∂R/∂v + f.
    pub(super) fn rates(
        &mut self,
        of_lagrangian: &Gradient,
        rayleigh: Option<Node>,
        force: Option<&[Node]>,
    ) -> Vec<Node> {
        let of_rayleigh =
            rayleigh.map(|root| self.derivation.gradient(&mut self.graph, root)).unwrap_or_default();
        (0..self.n)
            .map(|index| {
                let (q, v) = (self.variable(index, false), self.variable(index, true));
                let mut rate = of_lagrangian.get(&q).copied();
                if let Some(&friction) = of_rayleigh.get(&v) {
                    let opposite = self.graph.negated(friction);
                    rate = Some(self.added(rate, opposite));
                }
                let component = force.map(|components| components[index]);
                if let Some(component) = component.filter(|&f| self.graph.constant_value(f) != Some(0.0)) {
                    rate = Some(self.added(rate, component));
                }
                self.or_zero(rate)
            })
            .collect()
    }

    /// The reciprocals that corrections need and nothing else does: what they are off by, the next sweep
    /// sees.
    fn of_corrections_alone(&self, outputs: &[Node]) -> Vec<Node> {
        let (others, corrections) = outputs.split_at(2 * self.n);
        let others: BTreeSet<Node> = self.graph.reachable(others.iter().copied()).into_iter().collect();
        let is_reciprocal = |node: &Node| match self.graph.operation(*node) {
            Operation::Divide(one, _) => self.graph.constant_value(one) == Some(1.0),
            _ => false,
        };
        let mut alone = self.graph.reachable(corrections.iter().copied());
        alone.retain(|node| is_reciprocal(node) && !others.contains(node));
        alone
    }

    /// M⁻¹ `right`, M = ∂²L/∂v².
    fn solved(&mut self, of: &Derivatives, right: &[Node]) -> Option<Vec<Node>> {
        let n = self.n;
        if self.products(of) > MAX_PRODUCTS {
            return None;
        }
        // W = L D below the diagonal, and 1/D.
        let mut lower: Vec<Vec<Option<Node>>> = vec![vec![None; n]; n];
        let mut scaled = lower.clone();
        let mut reciprocals = Vec::new();
        for j in 0..n {
            for i in j..n {
                let mut entry = self.second(of, (i, true), (j, true));
                for k in 0..j {
                    if let (Some(a), Some(b)) = (lower[i][k], scaled[j][k]) {
                        let product = self.graph.times(a, b);
                        let opposite = self.graph.negated(product);
                        entry = Some(self.added(entry, opposite));
                    }
                }
                if i == j {
                    reciprocals.push(self.graph.reciprocal(entry?));
                } else {
                    scaled[i][j] = entry;
                    lower[i][j] = entry.map(|entry| self.graph.times(entry, reciprocals[j]));
                }
            }
        }
        let mut x = right.to_vec();
        for i in 0..n {
            for j in 0..i {
                x[i] = self.reduced(x[i], lower[i][j], x[j]);
            }
        }
        for (x, reciprocal) in x.iter_mut().zip(reciprocals) {
            *x = self.graph.times(reciprocal, *x);
        }
        for i in (0..n).rev() {
            for j in i + 1..n {
                x[i] = self.reduced(x[i], lower[j][i], x[j]);
            }
        }
        Some(x)
    }

    /// x − factor y.
    fn reduced(&mut self, x: Node, factor: Option<Node>, y: Node) -> Node {
        match factor {
            Some(factor) => {
                let product = self.graph.times(factor, y);
                self.graph.minus(x, product)
            }
            None => x,
        }
    }

    /// How many products the factorisation takes, with what fills in.
    fn products(&mut self, of: &Derivatives) -> usize {
        let mut below: Vec<BTreeSet<usize>> = (0..self.n)
            .map(|j| (j + 1..self.n).filter(|&i| self.second(of, (i, true), (j, true)).is_some()).collect())
            .collect();
        let mut products = 0;
        for k in 0..self.n {
            let column = below[k].clone();
            products += column.len() * column.len();
            for &j in &column {
                let filled = column.iter().copied().filter(|&i| i > j);
                below[j].extend(filled);
            }
        }
        products
    }
}
