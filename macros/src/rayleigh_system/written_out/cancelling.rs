//! Terms that cancel in p0: what rounding takes of it where last places of q and v do not show it.
//!
//! At an equilibrium forces cancel. Where they do at q ≠ 0, a last place of q moves them by what they round by; not
//! so at q = 0, where (q − 1) + (q + 1) rounds at ε and q has no places. Three kinds of expressions tell these apart:
//!
//! ```text
//! vanishing    0 with q and v: its rounding is a share of what last places of q and v do         q, k q, sin q, q cos q
//! nonzero      rounded by a share of its own size, or of what last places do                     q − 1, cos q, (q − 1)²
//! cancelling   a sum of two that are nonzero, and what is made of it; sin (q − 1)                 (q − 1) + (q + 1)
//! ```
//!
//! One nonzero term of p0 is balanced by p and v, whose rounding is known. Of a component that is cancelling the
//! running error bound is written out, over ε (N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2002,
//! section 3.3): the sizes of what each operation rounds, carried to the result.

use std::collections::HashMap;

use super::super::differentiate::{Order, partials::partials};
use super::super::graph::{Function, PairFunction};
use super::*;

/// How an expression is rounded: the larger includes the smaller.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Vanishing,
    Nonzero,
    Cancelling,
}

impl Code<'_> {
    /// Sizes of the terms that cancel, for each component of p0; nothing where none can, or where they would be too
    /// long to be written.
    pub(super) fn cancelling_terms(&mut self, p0: &[Node]) -> Option<Vec<Node>> {
        let kinds = self.kinds(p0);
        let cancelling: Vec<Node> =
            p0.iter().copied().filter(|component| kinds[component] == Kind::Cancelling).collect();
        if cancelling.is_empty() {
            return None;
        }
        let mut sizes: HashMap<Node, Node> = HashMap::new();
        for node in self.graph.reachable(cancelling) {
            if kinds[&node] != Kind::Vanishing
                && let Some(size) = self.rounded_in(node, &sizes)
            {
                sizes.insert(node, size);
            }
        }
        let terms: Vec<Node> = p0
            .iter()
            .map(|component| sizes.get(component).filter(|_| kinds[component] == Kind::Cancelling).copied())
            .map(|size| self.or_zero(size))
            .collect();
        let is_short =
            !self.graph.is_full() && self.graph.operations(terms.iter().copied()) <= MOST_OPERATIONS / 2;
        is_short.then_some(terms)
    }

    /// The kinds of all that `roots` are made of.
    fn kinds(&self, roots: &[Node]) -> HashMap<Node, Kind> {
        let mut kinds = HashMap::new();
        for node in self.graph.reachable(roots.iter().copied()) {
            kinds.insert(node, self.kind(node, |argument| kinds[&argument]));
        }
        kinds
    }

    fn kind(&self, node: Node, of: impl Fn(Node) -> Kind) -> Kind {
        use Kind::{Cancelling, Nonzero, Vanishing};
        // A factor or a function of something that is known to its own size is.
        let unless_cancelling = |kind: Kind| if kind == Cancelling { Cancelling } else { Nonzero };
        let sum = |a: Node, b: Node| match (of(a), of(b)) {
            (Nonzero, Nonzero) => Cancelling,
            (a, b) => a.max(b),
        };
        let product = |a: Node, b: Node| match (of(a), of(b)) {
            (Cancelling, _) | (_, Cancelling) => Cancelling,
            (a, b) => a.min(b),
        };
        match self.graph.operation(node) {
            Operation::Coordinate(_) | Operation::Velocity(_) => Vanishing,
            _ if !self.graph.depends(node) => Nonzero,
            Operation::Add(a, b) | Operation::Subtract(a, b) => sum(a, b),
            Operation::Multiply(a, b) => product(a, b),
            Operation::MultiplyAdd(a, b, c) => match (product(a, b), of(c)) {
                (Nonzero, Nonzero) => Cancelling,
                (product, c) => product.max(c),
            },
            Operation::Divide(a, b) => match of(b) {
                Cancelling => Cancelling,
                _ => of(a),
            },
            Operation::Negate(a) => of(a),
            Operation::Power(a, n) if n > 0 => of(a),
            Operation::Power(a, _) => unless_cancelling(of(a)),
            Operation::Function(function, x) => match function {
                Function::Abs | Function::Sqrt | Function::Cbrt => of(x),
                Function::Recip | Function::Exp | Function::Exp2 | Function::Cosh | Function::Signum => {
                    unless_cancelling(of(x))
                }
                Function::Cos | Function::Ln | Function::Log2 | Function::Log10 | Function::Acos => {
                    if of(x) == Vanishing { Nonzero } else { Cancelling }
                }
                _ => {
                    if of(x) == Vanishing {
                        Vanishing
                    } else {
                        Cancelling
                    }
                }
            },
            Operation::Pair(PairFunction::Hypot, a, b) => of(a).max(of(b)),
            Operation::Pair(PairFunction::Copysign, a, _) => of(a),
            Operation::Pair(PairFunction::Powf, a, b) if !self.graph.depends(b) => of(a),
            Operation::Pair(_, a, b) => {
                if of(a).max(of(b)) == Vanishing {
                    Nonzero
                } else {
                    Cancelling
                }
            }
            Operation::Select(_, a, b) => of(a).max(of(b)),
            // An input; truth values have no size.
            _ => Nonzero,
        }
    }

    /// The rounding of the expression, over ε, given that of its arguments; nothing where it takes
    /// nothing.
    fn rounded_in(&mut self, node: Node, sizes: &HashMap<Node, Node>) -> Option<Node> {
        let operation = self.graph.operation(node);
        if !self.graph.depends(node) || operation.is_literal() || operation.is_truth() {
            return None;
        }
        match operation {
            Operation::Negate(a) => return sizes.get(&a).copied(),
            Operation::Select(condition, a, b) => {
                let [a, b] = [a, b].map(|branch| sizes.get(&branch).copied());
                if a.is_none() && b.is_none() {
                    return None;
                }
                let [a, b] = [a, b].map(|size| self.or_zero(size));
                return Some(self.graph.select(condition, a, b));
            }
            _ => {}
        }
        let mut size = self.graph.function(Function::Abs, node);
        for (argument, slope) in partials(&mut self.graph, node, operation, Order::First).first {
            if let Some(&of_argument) = sizes.get(&argument) {
                let carried = match self.graph.constant_value(slope) {
                    Some(slope) => self.graph.scaled(slope.abs(), of_argument),
                    None => {
                        let slope = self.graph.function(Function::Abs, slope);
                        self.graph.times(slope, of_argument)
                    }
                };
                size = self.graph.plus(size, carried);
            }
        }
        Some(size)
    }
}
