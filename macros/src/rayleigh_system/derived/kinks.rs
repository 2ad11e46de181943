//! Kinks of R: where |u| stands in it, with u linear in v.
//!
//! ```text
//! R(q, v) = R_s(q, v) + Σₖ Fₖ(q) |uₖ(q, v)|        Fₖ = ∂R/∂|uₖ| where all |uₖ| are 0
//! ```
//!
//! `abs`, `hypot` and `sqrt` of a sum of squares are lengths; max(a, b) = ½(a + b) + ½|a − b|, and min
//! likewise. A length whose share of R vanishes with it, as in |v|³ and v²|v|, is no kink.

mod candidates;
mod squares;

use std::collections::HashMap;

use super::super::graph::Function;
use super::*;
use candidates::Extremum;

/// The kinks of R.
#[derive(Default)]
pub struct Kinks {
    /// Whether slips and limits hold no coordinate.
    pub is_uniform: bool,
    /// Whether R holds each |u| with a factor, and not in another function.
    pub is_proportional: bool,
    /// The methods that write kinks, whatever the fields are, at which the motion can stop.
    pub certain: Vec<Span>,
    /// Kinks that no rule takes, and the methods that write them.
    pub faults: Vec<(Fault, Span)>,
    /// R_s, unless nothing is left of R.
    pub(super) smooth: Option<Node>,
    elements: Vec<Element>,
}

impl Kinks {
    /// How many components each element has.
    pub fn sizes(&self) -> Vec<usize> {
        self.elements.iter().map(|element| element.slip.len()).collect()
    }

    /// The number of all components.
    pub fn components(&self) -> usize {
        self.sizes().iter().sum()
    }
}

/// A kink that no rule takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Of what is not linear in v.
    NotLinear,
    /// Its share of R depends on v or on another.
    NotApart,
    /// A length with a share of R that is not proportional to it.
    LengthNotProportional,
    /// The root of a quadratic form that is not written as a sum of squares.
    NotSquares,
}

/// Fₖ and uₖ.
struct Element {
    limit: Node,
    slip: Vec<Node>,
}

impl Deriving<'_> {
    /// Finds the kinks of R.
    pub(super) fn find_kinks(&mut self) -> Kinks {
        let Some(root) = self.rayleigh else { return Kinks::default() };
        let mut kinks =
            Kinks { smooth: Some(root), is_uniform: true, is_proportional: true, ..Kinks::default() };
        let candidates = self.candidates(root);
        if candidates.is_empty() {
            return kinks;
        }
        let lengths: Vec<Node> = (0..candidates.len()).map(|k| self.graph.unknown(k)).collect();
        let mut open = HashMap::new();
        for (candidate, &length) in candidates.iter().zip(&lengths) {
            let stands = self.standing_for(candidate, length);
            open.insert(candidate.node, stands);
        }
        let with_lengths = self.graph.replaced(root, open);
        let by_length = self.derivation.gradient(&mut self.graph, with_lengths);
        let zero = self.graph.constant(0.0);
        let at_rest: HashMap<Node, Node> = lengths.iter().map(|&length| (length, zero)).collect();
        let mut harmless = HashMap::new();
        let mut shares = Vec::new();
        for (candidate, &length) in candidates.iter().zip(&lengths) {
            let Some(&share) = by_length.get(&length) else { continue };
            let limit = self.graph.replaced(share, at_rest.clone());
            let mut without_slip: HashMap<Node, Node> =
                candidate.slip.iter().map(|&slip| (slip, zero)).collect();
            if let [slip] = candidate.slip[..]
                && let Some(velocity) = self.stands_with(slip)
            {
                without_slip.insert(velocity, zero);
            }
            let where_it_holds = self.graph.replaced(limit, without_slip);
            if self.graph.constant_value(where_it_holds) == Some(0.0) {
                harmless.insert(length, candidate.node);
                continue;
            }
            // The share may hold v beside, where that changes no slope at the kink, as in v²|v|.
            let limit = if candidate.slip.len() == 1 && !self.reads_velocity(where_it_holds) {
                where_it_holds
            } else {
                limit
            };
            let (is_own, is_certain) = (limit == share, !self.vanishes_in_a_branch(where_it_holds));
            shares.push((candidate, length, limit, is_own, is_certain));
        }
        kinks.is_proportional = shares.iter().all(|&(.., is_own, _)| is_own);
        // Lengths with a limit of their own leave R; of others |u| stays as it stands, less its kink.
        let mut rest = at_rest;
        rest.extend(harmless.iter().map(|(&length, &node)| (length, node)));
        let mut kinked = Vec::new();
        for &(candidate, length, limit, is_own, _) in &shares {
            if !is_own {
                let node = match candidate.slip[..] {
                    [slip] => self.graph.function(Function::Abs, slip),
                    _ => candidate.node,
                };
                rest.insert(length, node);
                kinked.push(self.graph.times(limit, node));
            }
        }
        let mut smooth = self.graph.replaced(with_lengths, rest);
        for term in kinked {
            smooth = self.graph.minus(smooth, term);
        }
        for (candidate, _, limit, is_own, is_certain) in shares {
            let is_form = matches!(candidate.kind, Extremum::Form);
            let faults = [
                (is_form, Fault::NotSquares),
                (!is_form && candidate.slip.len() > 1 && !is_own, Fault::LengthNotProportional),
                (self.reads_velocity(limit), Fault::NotApart),
                (!self.is_linear_in_velocity(&candidate.slip), Fault::NotLinear),
            ];
            let at = self.written_at(candidate.node);
            let before = kinks.faults.len();
            kinks.faults.extend(faults.into_iter().filter(|(holds, _)| *holds).map(|(_, fault)| (fault, at)));
            let is_taken = kinks.faults.len() == before;
            if is_certain && (is_taken || is_form) {
                kinks.certain.push(at);
            }
            if is_taken {
                kinks.elements.push(Element { limit, slip: candidate.slip.clone() });
            }
        }
        kinks.smooth = (self.graph.constant_value(smooth).is_none()).then_some(smooth);
        kinks.is_uniform =
            kinks.elements.iter().flat_map(|element| element.slip.iter().chain([&element.limit])).all(
                |&node| !self.reads_kind(node, |operation| matches!(operation, Operation::Coordinate(_))),
            );
        kinks
    }

    /// The method that writes a node, or one in it; otherwise the name of R.
    fn written_at(&self, node: Node) -> Span {
        let own = [node].into_iter().chain(self.graph.operation(node).arguments());
        let method = own.into_iter().find_map(|node| self.methods.get(&node).copied());
        let mut functions = self.system.source.functions();
        let name = || Some(functions.find(|of| of.sig.ident == Part::Rayleigh.name())?.sig.ident.span());
        method.or_else(name).unwrap_or_else(|| self.system.name.span())
    }

    /// The functions of `SmoothRayleigh` and `DryFriction`.
    pub(super) fn kinks(&mut self, kinks: &Kinks) -> Made<Vec<Routine>> {
        let mut functions = vec![self.slips(kinks)?];
        if !kinks.is_uniform {
            functions.push(self.slip_curvature(kinks)?);
        }
        if !self.system.parameters.is_empty() {
            functions.push(self.slips_by_parameters(kinks)?);
        }
        if let Some(root) = kinks.smooth {
            functions.push(self.derivatives(Of::SmoothRayleigh, self.system.home(), root, "r")?);
        }
        Ok(functions)
    }

    fn slip_curvature(&mut self, kinks: &Kinks) -> Made<Routine> {
        let force = self.friction(kinks);
        let by_q = self.rows(&force);
        let outputs = self.matrix(|deriving, i, j| {
            let variable = deriving.variable(j, false);
            by_q[i].get(&variable).copied()
        });
        self.made(Of::SlipCurvature, self.system.home(), &outputs)
    }

    /// ∂u/∂θ, and ∂/∂θ of the friction at given s.
    fn slips_by_parameters(&mut self, kinks: &Kinks) -> Made<Routine> {
        let slips: Vec<Node> = kinks.elements.iter().flat_map(|element| element.slip.clone()).collect();
        let mut outputs = Vec::new();
        for components in [slips, self.friction(kinks)] {
            outputs.extend(self.columns_by_parameters(&components));
        }
        self.made(Of::SlipsByParameters, self.system.home(), &outputs)
    }

    /// Σ F s·∂u/∂v.
    fn friction(&mut self, kinks: &Kinks) -> Vec<Node> {
        let components: Vec<(Node, Node)> = kinks
            .elements
            .iter()
            .flat_map(|element| element.slip.iter().map(|&slip| (element.limit, slip)))
            .collect();
        let mut sums = vec![None; self.n];
        for (k, (limit, slip)) in components.into_iter().enumerate() {
            let row = self.derivation.gradient(&mut self.graph, slip);
            let factor = self.graph.entry("forces", k);
            let factor = self.graph.times(factor, limit);
            for (i, sum) in sums.iter_mut().enumerate() {
                let variable = self.variable(i, true);
                if let Some(&entry) = row.get(&variable) {
                    let term = self.graph.times(factor, entry);
                    *sum = Some(self.added(*sum, term));
                }
            }
        }
        sums.into_iter().map(|sum| self.or_zero(sum)).collect()
    }

    fn slips(&mut self, kinks: &Kinks) -> Made<Routine> {
        let slips: Vec<Node> = kinks.elements.iter().flat_map(|element| element.slip.clone()).collect();
        let rows = self.rows(&slips);
        let mut outputs = slips.clone();
        for is_velocity in [true, false] {
            for j in 0..self.n {
                let variable = self.variable(j, is_velocity);
                for row in &rows {
                    outputs.push(self.or_zero(row.get(&variable).copied()));
                }
            }
        }
        for element in &kinks.elements {
            outputs.extend(element.slip.iter().map(|_| element.limit));
        }
        self.made(Of::Slips, self.system.home(), &outputs)
    }

    /// Whether a limit is 0 in a branch that fields decide on: |v| is smooth where it is below a width of
    /// theirs.
    fn vanishes_in_a_branch(&self, limit: Node) -> bool {
        match self.graph.operation(limit) {
            Operation::Select(_, a, b) => [a, b].into_iter().any(|branch| {
                self.graph.constant_value(branch) == Some(0.0) || self.vanishes_in_a_branch(branch)
            }),
            Operation::Multiply(a, b) => self.vanishes_in_a_branch(a) || self.vanishes_in_a_branch(b),
            Operation::Divide(a, _) | Operation::Negate(a) => self.vanishes_in_a_branch(a),
            _ => false,
        }
    }

    fn is_linear_in_velocity(&mut self, slips: &[Node]) -> bool {
        let rows = self.rows(slips);
        rows.iter().all(|row| {
            row.iter().all(|(&variable, &slope)| {
                !matches!(self.graph.operation(variable), Operation::Velocity(_))
                    || !self.reads_velocity(slope)
            })
        })
    }

    pub(super) fn reads(&self, root: Node, node: Node) -> bool {
        self.graph.reachable([root]).contains(&node)
    }

    fn reads_kind(&self, root: Node, is_meant: impl Fn(Operation) -> bool) -> bool {
        self.graph.reachable([root]).into_iter().any(|node| is_meant(self.graph.operation(node)))
    }
}
