//! Kinks of R: where |u| stands in it, with u linear in v.
//!
//! ```text
//! R(q, v) = R_s(q, v) + Σₖ Fₖ(q) |uₖ(q, v)|        Fₖ = ∂R/∂|uₖ| where all |uₖ| are 0
//! ```
//!
//! `abs`, `hypot` and `sqrt` of a sum of squares are lengths; max(a, b) = ½(a + b) + ½|a − b|, and min
//! likewise. A length whose share of R vanishes with it, as in |v|³ and v²|v|, is no kink.

use std::collections::HashMap;

use super::super::graph::{Comparison, Function, PairFunction, Predicate};
use super::*;

/// The kinks of R.
#[derive(Default)]
pub struct Kinks {
    /// Whether slips and limits hold no coordinate.
    pub is_uniform: bool,
    /// Whether R holds each |u| with a factor, and not in another function.
    pub is_proportional: bool,
    /// The methods that write kinks, one for each element.
    pub written: Vec<Span>,
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
}

/// Fₖ and uₖ.
struct Element {
    limit: Node,
    slip: Vec<Node>,
}

/// A node of R that has a kink where this length is 0, and what it is with `length` in place of that.
struct Candidate {
    node: Node,
    slip: Vec<Node>,
    kind: Extremum,
}

/// The part that a length has of its node.
#[derive(Clone, Copy)]
enum Extremum {
    /// All of it.
    Length,
    /// ½(a + b) + ½|a − b|, or with a minus.
    Of(Node, Node, bool),
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
            let without_slip = candidate.slip.iter().map(|&slip| (slip, zero)).collect();
            let where_it_holds = self.graph.replaced(limit, without_slip);
            if self.graph.constant_value(where_it_holds) == Some(0.0) {
                harmless.insert(length, candidate.node);
                continue;
            }
            shares.push((candidate, length, share, limit));
        }
        let mut rest = at_rest;
        rest.extend(harmless.iter().map(|(&length, &node)| (length, node)));
        let mut smooth = self.graph.replaced(with_lengths, rest);
        let own: Vec<bool> = shares
            .iter()
            .map(|&(.., share, _)| !lengths.iter().any(|&length| self.reads(share, length)))
            .collect();
        let is_affine = own.iter().all(|&is_own| is_own);
        kinks.is_proportional = is_affine;
        if !is_affine {
            // R without the lengths' own shares, |u| as it stands.
            smooth = root;
            for &(candidate, .., limit) in &shares {
                let node = match candidate.kind {
                    Extremum::Length => candidate.node,
                    Extremum::Of(..) => self.graph.function(Function::Abs, candidate.slip[0]),
                };
                let term = self.graph.times(limit, node);
                smooth = self.graph.minus(smooth, term);
            }
        }
        for ((candidate, .., limit), is_own) in shares.into_iter().zip(own) {
            let faults = [
                (candidate.slip.len() > 1 && !is_own, Fault::LengthNotProportional),
                (self.reads_velocity(limit), Fault::NotApart),
                (!self.is_linear_in_velocity(&candidate.slip), Fault::NotLinear),
            ];
            let at = self.methods.get(&candidate.node).copied().unwrap_or_else(|| self.system.name.span());
            let before = kinks.faults.len();
            kinks.faults.extend(faults.into_iter().filter(|(holds, _)| *holds).map(|(_, fault)| (fault, at)));
            if kinks.faults.len() == before {
                kinks.written.push(at);
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

    /// The nodes of R that have a kink of their own in v.
    fn candidates(&mut self, root: Node) -> Vec<Candidate> {
        let mut found: Vec<Candidate> = Vec::new();
        for node in self.graph.reachable([root]) {
            let operation = self.graph.operation(node);
            let has_kink = matches!(
                operation,
                Operation::Function(Function::Abs | Function::Sqrt, _)
                    | Operation::Pair(PairFunction::Hypot, ..)
                    | Operation::Select(..)
            );
            // What is below is looked at for these alone.
            if !has_kink || !self.reads_velocity(node) {
                continue;
            }
            let candidate = match operation {
                Operation::Function(Function::Abs, x) => Some((vec![x], Extremum::Length)),
                Operation::Pair(PairFunction::Hypot, a, b) => {
                    self.sides(a, b).map(|sides| (sides, Extremum::Length))
                }
                Operation::Function(Function::Sqrt, x) => {
                    self.squares(x).map(|sides| (sides, Extremum::Length))
                }
                Operation::Select(condition, b, a) => self
                    .extremum(condition, a, b)
                    .map(|is_max| (vec![self.graph.minus(b, a)], Extremum::Of(a, b, is_max))),
                _ => None,
            };
            found.extend(candidate.map(|(slip, kind)| Candidate { node, slip, kind }));
        }
        found
    }

    /// Both sides of a triangle, with those of triangles within; nothing where one has no v in it.
    fn sides(&self, a: Node, b: Node) -> Option<Vec<Node>> {
        let mut sides = Vec::new();
        for side in [a, b] {
            match self.graph.operation(side) {
                Operation::Pair(PairFunction::Hypot, a, b) => sides.extend(self.sides(a, b)?),
                _ if self.reads_velocity(side) => sides.push(side),
                _ if self.graph.constant_value(side) == Some(0.0) => {}
                _ => return None,
            }
        }
        Some(sides)
    }

    /// The numbers whose squares are added; nothing where a term is no square, or has no v in it.
    fn squares(&self, sum: Node) -> Option<Vec<Node>> {
        let (mut open, mut found) = (vec![sum], Vec::new());
        while let Some(node) = open.pop() {
            match self.graph.operation(node) {
                Operation::Add(a, b) => open.extend([b, a]),
                Operation::Multiply(a, b) if a == b && self.reads_velocity(a) => found.push(a),
                Operation::Power(a, 2) if self.reads_velocity(a) => found.push(a),
                Operation::MultiplyAdd(a, b, c) if a == b && self.reads_velocity(a) => {
                    found.push(a);
                    open.push(c);
                }
                _ if self.graph.constant_value(node) == Some(0.0) => {}
                _ => return None,
            }
        }
        Some(found)
    }

    /// Whether it is max(a, b), or min(a, b), as these are lowered.
    fn extremum(&self, condition: Node, a: Node, b: Node) -> Option<bool> {
        let Operation::Or(wins, missing) = self.graph.operation(condition) else { return None };
        if self.graph.operation(missing) != Operation::Is(Predicate::Nan, a) {
            return None;
        }
        match self.graph.operation(wins) {
            Operation::Compare(Comparison::Greater, x, y) if (x, y) == (b, a) => Some(true),
            Operation::Compare(Comparison::Less, x, y) if (x, y) == (b, a) => Some(false),
            _ => None,
        }
    }

    /// The candidate's node with a length in place of its own.
    fn standing_for(&mut self, candidate: &Candidate, length: Node) -> Node {
        let Extremum::Of(a, b, is_max) = candidate.kind else { return length };
        let sum = self.graph.plus(a, b);
        let sum = if is_max { self.graph.plus(sum, length) } else { self.graph.minus(sum, length) };
        self.graph.scaled(0.5, sum)
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

    fn reads(&self, root: Node, node: Node) -> bool {
        self.graph.reachable([root]).contains(&node)
    }

    fn reads_kind(&self, root: Node, is_meant: impl Fn(Operation) -> bool) -> bool {
        self.graph.reachable([root]).into_iter().any(|node| is_meant(self.graph.operation(node)))
    }
}
