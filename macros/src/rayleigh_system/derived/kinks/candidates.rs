//! Where R may have kinks, and what stands there with a length in place of |u|.

use std::collections::HashMap;

use super::super::super::graph::{Comparison, Function, Node, Operation, PairFunction, Predicate};
use super::super::*;

/// A node of R that has a kink where this length is 0, and what it is with `length` in place of that.
pub(super) struct Candidate {
    pub(super) node: Node,
    pub(super) slip: Vec<Node>,
    pub(super) kind: Extremum,
}

/// The part that a length has of its node.
#[derive(Clone, Copy)]
pub(super) enum Extremum {
    /// All of it.
    Length,
    /// All of it, as the root of a form whose squares are not seen.
    Form,
    /// ½(a + b) + ½|a − b|, or with a minus.
    Of(Node, Node, bool),
    /// ½(a + b) + ½k|u|, where a − b = ±k u.
    Branch(Node, Node, Node),
    /// k|u|.
    Multiple(Node),
}

impl Deriving<'_> {
    /// The nodes of R that have a kink of their own in v.
    pub(super) fn candidates(&mut self, root: Node) -> Vec<Candidate> {
        let mut found: Vec<Candidate> = Vec::new();
        for node in self.graph.reachable([root]) {
            let operation = self.graph.operation(node);
            let has_kink = match operation {
                Operation::Function(Function::Abs | Function::Sqrt, _) | Operation::Select(..) => true,
                Operation::Pair(pair, ..) => {
                    matches!(pair, PairFunction::Hypot | PairFunction::Powf | PairFunction::Copysign)
                }
                Operation::Multiply(a, b) => self.is_sign(a) || self.is_sign(b),
                _ => false,
            };
            // What is below is looked at for these alone.
            if !has_kink || !self.reads_velocity(node) {
                continue;
            }
            let candidate = match operation {
                Operation::Function(Function::Abs, x) => Some((vec![x], Extremum::Length)),
                Operation::Pair(PairFunction::Hypot, a, b) => {
                    self.sides(a, b).map(|sides| (sides, Extremum::Length))
                }
                Operation::Function(Function::Sqrt, _) | Operation::Pair(PairFunction::Powf, ..) => {
                    let squared = self.squared(operation).map(|sides| (sides, Extremum::Length));
                    squared.or_else(|| Some((self.quadratic_under(operation)?, Extremum::Form)))
                }
                Operation::Pair(PairFunction::Copysign, x, sign) => {
                    let is_positive = self.graph.constant_value(sign).is_some_and(f64::is_sign_positive);
                    is_positive.then(|| (vec![x], Extremum::Length))
                }
                Operation::Multiply(a, b) => {
                    let signed = self.signed(a, b);
                    signed.or_else(|| self.signed(b, a)).map(|(x, kind)| (vec![x], kind))
                }
                Operation::Select(condition, b, a) => self
                    .extremum(condition, a, b)
                    .map(|is_max| (vec![self.graph.minus(b, a)], Extremum::Of(a, b, is_max)))
                    .or_else(|| self.branch(condition, b, a)),
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

    pub(super) fn velocities(&mut self) -> Vec<Node> {
        (0..self.n).map(|i| self.variable(i, true)).collect()
    }

    /// The velocity with which alone a slip is 0.
    pub(super) fn stands_with(&mut self, slip: Node) -> Option<Node> {
        let mut read = self.velocities().into_iter().filter(|&velocity| self.reads(slip, velocity));
        let velocity = read.next()?;
        (read.next().is_none() && self.vanishes_at_rest(slip)).then_some(velocity)
    }

    /// The kink of x times the sign of x, or of a velocity and a multiple of it.
    fn signed(&mut self, x: Node, sign: Node) -> Option<(Node, Extremum)> {
        let of = self.sign_of(sign)?;
        if of == x {
            return Some((x, Extremum::Length));
        }
        let velocity = self.stands_with(of)?;
        let slope = self.multiple(x, velocity)?;
        let along = self.constant_slope(of, velocity)?;
        let slope = if along > 0.0 { slope } else { self.graph.negated(slope) };
        Some((velocity, Extremum::Multiple(slope)))
    }

    fn is_sign(&self, node: Node) -> bool {
        self.sign_of(node).is_some()
    }

    /// The number that a node is the sign of.
    fn sign_of(&self, node: Node) -> Option<Node> {
        match self.graph.operation(node) {
            Operation::Function(Function::Signum, of) => Some(of),
            Operation::Pair(PairFunction::Copysign, one, of)
                if self.graph.constant_value(one) == Some(1.0) =>
            {
                Some(of)
            }
            _ => None,
        }
    }

    /// k, where a node is k times a velocity.
    fn multiple(&mut self, node: Node, velocity: Node) -> Option<Node> {
        let zero = self.graph.constant(0.0);
        let at_rest = self.graph.replaced(node, HashMap::from([(velocity, zero)]));
        let slope = self.derivation.gradient(&mut self.graph, node).get(&velocity).copied()?;
        (self.graph.constant_value(at_rest) == Some(0.0) && !self.reads_velocity(slope)).then_some(slope)
    }

    /// The derivative by a velocity, where that is a number and not 0.
    fn constant_slope(&mut self, node: Node, velocity: Node) -> Option<f64> {
        let slope = self.derivation.gradient(&mut self.graph, node).get(&velocity).copied()?;
        self.graph.constant_value(slope).filter(|slope| *slope != 0.0)
    }

    /// The kink where one velocity decides between `a`, if the condition holds, and `b`: they meet there
    /// with different slopes.
    fn branch(&mut self, condition: Node, a: Node, b: Node) -> Option<(Vec<Node>, Extremum)> {
        let Operation::Compare(comparison, x, y) = self.graph.operation(condition) else { return None };
        let is_above = match comparison {
            Comparison::Greater | Comparison::GreaterOrEqual => true,
            Comparison::Less | Comparison::LessOrEqual => false,
            _ => return None,
        };
        let (side, change) = (self.graph.minus(x, y), self.graph.minus(a, b));
        let velocity = self.stands_with(side)?;
        let along = self.constant_slope(side, velocity)?;
        let slope = self.multiple(change, velocity)?;
        let slope = if is_above == (along > 0.0) { slope } else { self.graph.negated(slope) };
        Some((vec![velocity], Extremum::Branch(a, b, slope)))
    }

    /// The candidate's node with a length in place of its own.
    pub(super) fn standing_for(&mut self, candidate: &Candidate, length: Node) -> Node {
        let (a, b) = match candidate.kind {
            Extremum::Length | Extremum::Form => return length,
            Extremum::Multiple(of) => return self.graph.times(of, length),
            Extremum::Of(a, b, _) | Extremum::Branch(a, b, _) => (a, b),
        };
        let sum = self.graph.plus(a, b);
        let sum = match candidate.kind {
            Extremum::Of(.., false) => self.graph.minus(sum, length),
            Extremum::Branch(.., slope) => {
                let own = self.graph.times(slope, length);
                self.graph.plus(sum, own)
            }
            _ => self.graph.plus(sum, length),
        };
        self.graph.scaled(0.5, sum)
    }
}
