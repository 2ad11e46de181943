//! Gradients and curvature of constraints.

use super::*;

impl Code<'_> {
    /// The functions of `Constrained`, but for the constraints as they are written.
    pub(super) fn constraints(&mut self, components: &[Node]) -> Written<TokenStream> {
        let scalar = &self.system.scalar;
        let (n, m) = (self.system.degrees.times(1), self.system.constraint_count());
        let home = self.system.home_of(Part::Constraints);
        let rows = self.rows(components);
        let mut outputs = components.to_vec();
        for j in 0..self.n {
            let variable = self.variable(j, false);
            for row in &rows {
                outputs.push(self.or_zero(row.get(&variable).copied()));
            }
        }
        let line = self.code(home, &outputs)?;
        let (values, gradients) = line.outputs.split_at(components.len());
        let gradients = matrix(gradients, components.len());
        let (q, statements) = (parameter("q", line.uses_coordinates), &line.statements);
        let inline = inlined(statements);
        let first = quote! {
            #inline
            fn constraint_gradients(&self, #q: &Vector) -> (SVector<#scalar, #m>, SMatrix<#scalar, #m, #n>) {
                #statements
                (SVector::from([#(#values),*]), #gradients)
            }
        };

        let mut sum = None;
        for (index, &component) in components.iter().enumerate() {
            let factor = self.vector_entry("lambda", index);
            let term = self.graph.times(factor, component);
            sum = Some(self.added(sum, term));
        }
        let sum = self.or_zero(sum);
        let of = self.derivation.hessian(&mut self.graph, sum, "");
        let outputs = self.block(&of, false, false);
        let line = self.code_taking(home, &outputs, &["lambda"])?;
        let curvature = matrix(&line.outputs, self.n);
        let (q, statements) = (parameter("q", line.uses_coordinates), &line.statements);
        let lambda = parameter("lambda", line.uses("lambda"));
        Ok(quote! {
            #first

            fn constraint_curvature(
                &self,
                #q: &Vector,
                #lambda: &SVector<#scalar, #m>,
            ) -> SMatrix<#scalar, #n, #n> {
                #statements
                #curvature
            }
        })
    }
}
