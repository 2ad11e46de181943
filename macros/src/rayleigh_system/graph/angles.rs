//! Sine and cosine of a sum of two angles from those of the two, where these are computed anyway.
//!
//! ```text
//! sin (a ± b) = sin a cos b ± cos a sin b,   cos (a ± b) = cos a cos b ∓ sin a sin b
//! ```
//!
//! Rounding moves the result by no more than rounding a and b would: |sin a cos b| ≤ |a|. So this is for
//! coordinates that are rounded sums themselves, as those of stages are.

use std::collections::{HashMap, HashSet};

use super::{Function, Graph, Node, Operation};

/// The rewriting of one function's expressions.
struct Angles {
    /// All whose sine or cosine is computed.
    all: HashSet<Node>,
    /// The node that each node has become.
    rewritten: HashMap<Node, Node>,
    /// Sine and cosine of angles.
    known: HashMap<Node, [Node; 2]>,
}

impl Graph {
    /// Rewrites `outputs` with sines and cosines of fewer angles. Nodes that conditions are made of stay:
    /// they have to choose as the user's function does.
    pub fn with_fewer_angles(&mut self, outputs: &[Node]) -> Vec<Node> {
        let nodes = self.reachable(outputs.iter().copied());
        let all = nodes.iter().filter_map(|&node| self.angle(node)).collect();
        let mut angles = Angles { all, rewritten: HashMap::new(), known: HashMap::new() };
        if !angles.all.iter().any(|&angle| angles.parts(self, angle).is_some()) {
            return outputs.to_vec();
        }
        let conditions = nodes
            .iter()
            .copied()
            .filter(|&node| matches!(self.operation(node), Operation::Compare(..) | Operation::Is(..)));
        let kept: HashSet<Node> = self.reachable(conditions).into_iter().collect();
        for node in nodes {
            let operation = self.operation(node);
            let new = match operation {
                _ if kept.contains(&node) => node,
                Operation::Function(Function::Sin, angle) => angles.sine_and_cosine(self, angle)[0],
                Operation::Function(Function::Cos, angle) => angles.sine_and_cosine(self, angle)[1],
                _ => self.node(operation.with_arguments(|argument| angles.rewritten[&argument])),
            };
            if new != node
                && let Some(name) = self.name(node).map(str::to_owned)
            {
                self.give_name(new, &name);
            }
            angles.rewritten.insert(node, new);
        }
        outputs.iter().map(|output| angles.rewritten[output]).collect()
    }

    /// The angle that the node is the sine or cosine of.
    fn angle(&self, node: Node) -> Option<Node> {
        match self.operation(node) {
            Operation::Function(Function::Sin | Function::Cos, angle) => Some(angle),
            _ => None,
        }
    }
}

impl Angles {
    /// The two that an angle is the sum or difference of; whether it is their sum.
    fn parts(&self, graph: &Graph, angle: Node) -> Option<([Node; 2], bool)> {
        let (parts, is_sum) = match graph.operation(angle) {
            Operation::Add(a, b) => ([a, b], true),
            Operation::Subtract(a, b) => ([a, b], false),
            _ => return None,
        };
        parts.iter().all(|part| self.all.contains(part)).then_some((parts, is_sum))
    }

    /// Sine and cosine of an angle all of whose arguments are rewritten.
    fn sine_and_cosine(&mut self, graph: &mut Graph, angle: Node) -> [Node; 2] {
        if let Some(&known) = self.known.get(&angle) {
            return known;
        }
        let both = match self.parts(graph, angle) {
            None => {
                let angle = self.rewritten[&angle];
                [graph.function(Function::Sin, angle), graph.function(Function::Cos, angle)]
            }
            Some((parts, is_sum)) => {
                let [[sin_a, cos_a], [sin_b, cos_b]] = parts.map(|part| self.sine_and_cosine(graph, part));
                let [of_sine, of_cosine] =
                    [[(sin_a, cos_b), (cos_a, sin_b)], [(cos_a, cos_b), (sin_a, sin_b)]]
                        .map(|pairs| pairs.map(|(a, b)| graph.times(a, b)));
                if is_sum {
                    [graph.plus(of_sine[0], of_sine[1]), graph.minus(of_cosine[0], of_cosine[1])]
                } else {
                    [graph.minus(of_sine[0], of_sine[1]), graph.plus(of_cosine[0], of_cosine[1])]
                }
            }
        };
        self.known.insert(angle, both);
        both
    }
}
