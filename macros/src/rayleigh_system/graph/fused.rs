//! Sums of products rounded once: `a.mul_add(b, c)` for a b + c, where the product stands in sums alone.

use std::collections::{HashMap, HashSet};

use super::{Graph, Node, Operation};

/// Uses of a product, in sums and elsewhere: sums take it only where all its uses are in sums.
#[derive(Clone, Copy, Default)]
struct Uses {
    in_sums: u32,
    elsewhere: u32,
}

impl Graph {
    /// Rewrites `outputs` with a product and the sum that it stands in as one operation. The first `written`
    /// nodes of the graph stay as they are, and so do those that conditions are made of.
    pub fn fused(&mut self, outputs: &[Node], written: usize) -> Vec<Node> {
        let nodes = self.reachable(outputs.iter().copied());
        let kept = self.kept(&nodes, written);
        let mut uses: HashMap<Node, Uses> = HashMap::new();
        for &node in &nodes {
            match self.operation(node) {
                // A product less itself is 0, and stays so.
                Operation::Add(a, b) | Operation::Subtract(a, b) if !kept.contains(&node) && a != b => {
                    [a, b].iter().for_each(|part| uses.entry(*part).or_default().in_sums += 1);
                }
                operation => {
                    operation.arguments().for_each(|part| uses.entry(part).or_default().elsewhere += 1);
                }
            }
        }
        outputs.iter().for_each(|output| uses.entry(*output).or_default().elsewhere += 1);
        let mut taken: HashSet<Node> = nodes
            .iter()
            .copied()
            .filter(|node| matches!(self.operation(*node), Operation::Multiply(..)))
            .filter(|node| uses.get(node).is_some_and(|uses| uses.elsewhere == 0))
            .collect();
        // Of two products in one sum one is rounded by itself.
        for &node in &nodes {
            if let Operation::Add(a, b) | Operation::Subtract(a, b) = self.operation(node)
                && taken.contains(&a)
                && taken.contains(&b)
            {
                let fewer = if uses[&a].in_sums < uses[&b].in_sums { b } else { a };
                taken.remove(&fewer);
            }
        }
        let mut fused: HashMap<Node, Node> = HashMap::new();
        for node in nodes {
            let new = if kept.contains(&node) { node } else { self.fused_node(node, &taken, &fused) };
            if new != node
                && let Some(name) = self.name(node).map(str::to_owned)
            {
                self.give_name(new, &name);
            }
            fused.insert(node, new);
        }
        outputs.iter().map(|output| fused[output]).collect()
    }

    /// The node on what its arguments have become; a sum with the product that it takes.
    fn fused_node(&mut self, node: Node, taken: &HashSet<Node>, fused: &HashMap<Node, Node>) -> Node {
        let operation = self.operation(node);
        let (product, term, signs) = match operation {
            Operation::Add(a, b) if taken.contains(&a) => (a, b, [false, false]),
            Operation::Add(a, b) if taken.contains(&b) => (b, a, [false, false]),
            Operation::Subtract(a, b) if taken.contains(&a) => (a, b, [false, true]),
            Operation::Subtract(a, b) if taken.contains(&b) => (b, a, [true, false]),
            _ => return self.node(operation.with_arguments(|argument| fused[&argument])),
        };
        let Operation::Multiply(x, y) = self.operation(product) else { return node };
        // The method is called on what changes.
        let (x, y) = if self.depends(y) && !self.depends(x) { (y, x) } else { (x, y) };
        let [product_is_negative, term_is_negative] = signs;
        let (mut x, y, mut term) = (fused[&x], fused[&y], fused[&term]);
        if product_is_negative {
            x = self.negated(x);
        }
        if term_is_negative {
            term = self.negated(term);
        }
        self.node(Operation::MultiplyAdd(x, y, term))
    }
}
