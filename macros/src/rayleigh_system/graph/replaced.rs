//! Expressions with others in place of some of theirs.

use std::collections::{BTreeSet, HashMap};

use quote::format_ident;

use super::{Graph, Node, Operation};

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
            Operation::Multiply(a, b) if is(a, 0.0) || is(b, 0.0) => self.constant(0.0),
            Operation::Multiply(a, b) if is(a, 1.0) => b,
            Operation::Multiply(a, b) | Operation::Divide(a, b) if is(b, 1.0) => a,
            Operation::Divide(a, _) if is(a, 0.0) => self.constant(0.0),
            Operation::Negate(a) => self.negated(a),
            Operation::Power(a, n) if n > 0 && is(a, 0.0) => self.constant(0.0),
            Operation::MultiplyAdd(a, b, c) if is(a, 0.0) || is(b, 0.0) => c,
            Operation::Function(function, a) if is(a, 0.0) && matches!(function.method()(0.0), 0.0 | 1.0) => {
                self.constant(function.method()(0.0))
            }
            other => self.node(other),
        }
    }
}
