//! Entries of gradients and Hessians; what is absent there is 0 where it is written.

use super::*;

impl Deriving<'_> {
    /// The gradient of each component.
    pub(super) fn rows(&mut self, components: &[Node]) -> Vec<Gradient> {
        components.iter().map(|&component| self.derivation.gradient(&mut self.graph, component)).collect()
    }

    pub(super) fn variable(&mut self, index: usize, velocity: bool) -> Node {
        self.graph.node(if velocity { Operation::Velocity(index) } else { Operation::Coordinate(index) })
    }

    pub(super) fn or_zero(&mut self, node: Option<Node>) -> Node {
        node.unwrap_or_else(|| self.graph.constant(0.0))
    }

    /// ∂f/∂q or ∂f/∂v, entry by entry.
    pub(super) fn covector(&mut self, gradient: &Gradient, velocity: bool) -> Vec<Node> {
        (0..self.n)
            .map(|index| {
                let variable = self.variable(index, velocity);
                self.or_zero(gradient.get(&variable).copied())
            })
            .collect()
    }

    /// ∂²f by the variable `row` and the variable `column`, if it is not 0 by structure.
    pub(super) fn second(
        &mut self,
        of: &Derivatives,
        row: (usize, bool),
        column: (usize, bool),
    ) -> Option<Node> {
        let (a, b) = (self.variable(row.0, row.1), self.variable(column.0, column.1));
        of.hessian.get(&(a.min(b), a.max(b))).copied()
    }

    /// The blocks qq, qv and vv of the Hessian.
    pub(super) fn blocks(&mut self, of: &Derivatives) -> Vec<Node> {
        [(false, false), (false, true), (true, true)]
            .map(|(row_velocity, column_velocity)| {
                self.matrix(|deriving, i, j| deriving.second(of, (i, row_velocity), (j, column_velocity)))
            })
            .concat()
    }

    /// The entries of an n×n matrix, column by column.
    pub(super) fn matrix(
        &mut self,
        mut entry: impl FnMut(&mut Self, usize, usize) -> Option<Node>,
    ) -> Vec<Node> {
        let mut entries = Vec::new();
        for j in 0..self.n {
            for i in 0..self.n {
                let entry = entry(self, i, j);
                entries.push(self.or_zero(entry));
            }
        }
        entries
    }

    /// sum + term, where there is a sum already.
    pub(super) fn added(&mut self, sum: Option<Node>, term: Node) -> Node {
        match sum {
            Some(sum) => self.graph.plus(sum, term),
            None => term,
        }
    }
}
