//! Local derivatives as factors of what the sweep carries.

use super::super::graph::{Graph, Node, Operation};
use super::partials::Partials;

/// A local derivative.
#[derive(Clone, Copy)]
pub enum Factor {
    Whole(Node),
    /// The derivative of one branch of a selection; that of the other is 0 by structure.
    Branch {
        condition: Node,
        /// Whether it is the branch where the condition holds.
        holds: bool,
        derivative: Node,
    },
}

impl Factor {
    /// The derivatives of both branches, if either has one.
    pub fn selected(graph: &mut Graph, condition: Node, branches: [Option<Node>; 2]) -> Option<Self> {
        match branches {
            [Some(a), Some(b)] => Some(Self::Whole(graph.select(condition, a, b))),
            [Some(derivative), None] => Some(Self::Branch { condition, holds: true, derivative }),
            [None, Some(derivative)] => Some(Self::Branch { condition, holds: false, derivative }),
            [None, None] => None,
        }
    }

    /// weight × self.
    pub fn times(self, graph: &mut Graph, weight: Node) -> Node {
        match self {
            Self::Whole(derivative) => graph.times(weight, derivative),
            // The product stands in the branch, so that the other one's 0 is multiplied by nothing.
            Self::Branch { condition, holds, derivative } => {
                let product = graph.times(weight, derivative);
                in_branch(graph, condition, holds, product)
            }
        }
    }

    /// weight × self × other of one operation, unless no branch has both.
    pub fn times_both(self, graph: &mut Graph, weight: Node, other: Self) -> Option<Node> {
        let (condition, holds) = match (self, other) {
            (Self::Whole(a), Self::Whole(b)) => {
                let product = graph.times(weight, a);
                return Some(graph.times(product, b));
            }
            (Self::Branch { holds: a, .. }, Self::Branch { holds: b, .. }) if a != b => return None,
            (Self::Branch { condition, holds, .. }, _) | (_, Self::Branch { condition, holds, .. }) => {
                (condition, holds)
            }
        };
        let product = self.within(graph, condition, holds).times(graph, weight);
        let product = other.within(graph, condition, holds).times(graph, product);
        Some(in_branch(graph, condition, holds, product))
    }

    /// The factor inside a branch, where a selection by its condition is decided.
    fn within(self, graph: &Graph, condition: Node, holds: bool) -> Self {
        match self {
            Self::Branch { derivative, .. } => Self::Whole(derivative),
            Self::Whole(node) => match graph.operation(node) {
                Operation::Select(of, a, b) if of == condition => Self::Whole(if holds { a } else { b }),
                _ => self,
            },
        }
    }
}

/// `node` in one branch, 0 in the other.
fn in_branch(graph: &mut Graph, condition: Node, holds: bool, node: Node) -> Node {
    let zero = graph.constant(0.0);
    if holds { graph.select(condition, node, zero) } else { graph.select(condition, zero, node) }
}

/// The partial derivatives of an operation, as factors.
#[derive(Default)]
pub struct Local {
    /// (a, ∂/∂a).
    pub first: Vec<(Node, Factor)>,
    /// (a, b, ∂²/∂a∂b), each pair once.
    pub second: Vec<(Node, Node, Factor)>,
}

impl From<Partials> for Local {
    fn from(Partials { first, second }: Partials) -> Self {
        Self {
            first: first.into_iter().map(|(a, first)| (a, Factor::Whole(first))).collect(),
            second: second.into_iter().map(|(a, b, second)| (a, b, Factor::Whole(second))).collect(),
        }
    }
}
