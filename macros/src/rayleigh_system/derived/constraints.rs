//! Gradients and curvature of constraints.

use super::*;

impl Deriving<'_> {
    /// The functions of `Constrained`, but for the constraints as they are written.
    pub(super) fn constraints(&mut self, components: &[Node]) -> Made<[Routine; 2]> {
        let home = self.system.home_of(Part::Constraints);
        let rows = self.rows(components);
        let mut outputs = components.to_vec();
        for j in 0..self.n {
            let variable = self.variable(j, false);
            for row in &rows {
                outputs.push(self.or_zero(row.get(&variable).copied()));
            }
        }
        let gradients = self.made(Of::ConstraintGradients, home, &outputs)?;

        let mut sum = None;
        for (index, &component) in components.iter().enumerate() {
            let factor = self.graph.entry("lambda", index);
            let term = self.graph.times(factor, component);
            sum = Some(self.added(sum, term));
        }
        let sum = self.or_zero(sum);
        let of = self.derivation.hessian(&mut self.graph, sum, "");
        let outputs = self.matrix(|deriving, i, j| deriving.second(&of, (i, false), (j, false)));
        Ok([gradients, self.made(Of::ConstraintCurvature, home, &outputs)?])
    }
}
