//! Expressions with others in place of some of theirs.

use std::collections::{BTreeSet, HashMap};

use quote::format_ident;

use super::{Comparison, Function, Graph, Node, Operation, PairFunction};

impl Graph {
    /// A number of its own that derivatives are taken by, the `index`-th; nothing is written of it.
    pub fn unknown(&mut self, index: usize) -> Node {
        let name = format_ident!("unknown_{index}");
        self.placed(quote::quote!(#name), false, true)
    }

    /// The expression with those in `replaced` in place of its own; what a 0 makes 0 is left out.
    pub fn replaced(&mut self, root: Node, mut replaced: HashMap<Node, Node>) -> Node {
        let mut new = BTreeSet::new();
        let mut open = vec![root];
        while let Some(node) = open.pop() {
            if !replaced.contains_key(&node) && new.insert(node) {
                open.extend(self.operation(node).arguments());
            }
        }
        for node in new {
            let operation = self.operation(node);
            let with = operation.with_arguments(|argument| replaced[&argument]);
            let replacement = if with == operation { node } else { self.folded(with) };
            if let Some(name) = self.names.get(&node).cloned().filter(|_| replacement != node) {
                self.give_name(replacement, &name);
            }
            replaced.insert(node, replacement);
        }
        replaced[&root]
    }

    /// The operation, or what it is where an argument is 0.
    fn folded(&mut self, operation: Operation) -> Node {
        let is = |node: Node, value: f64| self.constant_value(node) == Some(value);
        match operation {
            Operation::Add(a, b) if is(a, 0.0) => b,
            Operation::Add(a, b) | Operation::Subtract(a, b) if is(b, 0.0) => a,
            Operation::Subtract(a, b) if is(a, 0.0) => self.negated(b),
            Operation::Subtract(a, b) if a == b => self.constant(0.0),
            Operation::Multiply(a, b) if is(a, 0.0) || is(b, 0.0) => self.constant(0.0),
            Operation::Multiply(a, b) if is(a, 1.0) => b,
            Operation::Multiply(a, b) | Operation::Divide(a, b) if is(b, 1.0) => a,
            Operation::Divide(a, _) if is(a, 0.0) => self.constant(0.0),
            Operation::Negate(a) if self.constant_value(a).is_none() => self.negated(a),
            Operation::Power(a, n) if n > 0 && is(a, 0.0) => self.constant(0.0),
            // An exponent that is not known is one of no infinite force.
            Operation::Pair(PairFunction::Powf, a, n)
                if is(a, 0.0) && self.computed(n).is_none_or(|n| n > 0.0) =>
            {
                self.constant(0.0)
            }
            Operation::MultiplyAdd(a, b, c) if is(a, 0.0) || is(b, 0.0) => c,
            Operation::Select(condition, a, b) => match self.decided(condition) {
                Some(true) => a,
                Some(false) => b,
                None if is(a, 0.0) && is(b, 0.0) => b,
                // A factor where it is 0, and otherwise 0.
                None if is(b, 0.0) && self.is_zero_where(a, condition) => b,
                None => self.select(condition, a, b),
            },
            other => match (self.exact(other), self.undone(other)) {
                (Some(value), _) => self.constant(value),
                (None, Some(node)) => node,
                (None, None) => self.node(other),
            },
        }
    }

    /// x of 2 · ½x.
    fn undone(&self, operation: Operation) -> Option<Node> {
        let Operation::Multiply(a, b) = operation else { return None };
        let Operation::Multiply(c, x) = self.operation(b) else { return None };
        (self.exact(Operation::Multiply(a, c)) == Some(1.0)).then_some(x)
    }

    /// The value of an operation on constants, where every computer has the same.
    fn exact(&self, operation: Operation) -> Option<f64> {
        let of = |node: Node| self.constant_value(node);
        match operation {
            Operation::Add(a, b) => Some(of(a)? + of(b)?),
            Operation::Subtract(a, b) => Some(of(a)? - of(b)?),
            Operation::Multiply(a, b) => Some(of(a)? * of(b)?),
            Operation::Divide(a, b) => Some(of(a)? / of(b)?),
            Operation::Negate(a) => Some(-of(a)?),
            Operation::Function(Function::Recip, a) => Some(1.0 / of(a)?),
            Operation::Function(function, a) => {
                let at = of(a).filter(|at| matches!(at, 0.0 | 1.0))?;
                Some(function.method()(at)).filter(|value| matches!(value, 0.0 | 1.0))
            }
            _ => None,
        }
    }

    /// The value of a constant, or of an operation on constants.
    fn computed(&self, node: Node) -> Option<f64> {
        self.constant_value(node).or_else(|| self.exact(self.operation(node)))
    }

    /// Whether the condition is that the number is 0.
    fn is_zero_where(&self, number: Node, condition: Node) -> bool {
        let Operation::Compare(Comparison::Equal, a, b) = self.operation(condition) else { return false };
        a == number && self.constant_value(b) == Some(0.0)
    }

    /// The truth of a condition on constants.
    fn decided(&self, condition: Node) -> Option<bool> {
        match self.operation(condition) {
            Operation::Compare(comparison, a, b) => {
                Some(comparison.holds(self.constant_value(a)?, self.constant_value(b)?))
            }
            Operation::Is(predicate, a) => Some(predicate.method()(self.constant_value(a)?)),
            Operation::Not(a) => Some(!self.decided(a)?),
            Operation::And(a, b) => Some(self.decided(a)? && self.decided(b)?),
            Operation::Or(a, b) => Some(self.decided(a)? || self.decided(b)?),
            _ => None,
        }
    }
}
