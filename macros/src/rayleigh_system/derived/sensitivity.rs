//! Derivatives on request: those by parameters, and the Hessians that second derivatives of the step need.

use syn::Expr;

use super::*;

impl Deriving<'_> {
    /// Derivatives by the parameters, if there are any; of this part of R.
    pub(super) fn all_by_parameters(&mut self, rayleigh: Option<Node>) -> Made<Vec<Routine>> {
        if self.system.parameters.is_empty() {
            return Ok(Vec::new());
        }
        let mut functions = vec![self.by_parameters(Part::Lagrangian, self.lagrangian)?];
        functions.extend(rayleigh.map(|root| self.by_parameters(Part::Rayleigh, root)).transpose()?);
        functions.extend(self.force.map(|components| self.force_by_parameters(components)).transpose()?);
        Ok(functions)
    }

    /// Hessians along vectors, if they are asked for.
    pub(super) fn all_along(&mut self) -> Made<Vec<Routine>> {
        if !self.system.second {
            return Ok(Vec::new());
        }
        let mut functions = vec![self.along_vectors(Part::Lagrangian, self.lagrangian)?];
        functions.extend(self.rayleigh.map(|root| self.along_vectors(Part::Rayleigh, root)).transpose()?);
        functions.extend(self.force.map(|components| self.force_along(components)).transpose()?);
        Ok(functions)
    }

    fn by_parameters(&mut self, part: Part, root: Node) -> Made<Routine> {
        let of = self.derivation.hessian(&mut self.graph, root, "");
        let outputs: Vec<Node> =
            [false, true].iter().flat_map(|&by| self.mixed_with_parameters(&of, by)).collect();
        self.made(Of::ByParameters(part), self.system.home(), &outputs)
    }

    fn force_by_parameters(&mut self, components: &[Node]) -> Made<Routine> {
        let outputs = self.columns_by_parameters(components);
        self.made(Of::ByParameters(Part::Force), self.system.home(), &outputs)
    }

    /// The derivatives of these components by the parameters, column by column.
    pub(super) fn columns_by_parameters(&mut self, components: &[Node]) -> Vec<Node> {
        let rows = self.rows(components);
        let mut entries = Vec::new();
        for expression in &self.system.parameters {
            let parameter = self.graph.listed(expression);
            for row in &rows {
                entries.push(self.or_zero(row.get(&parameter).copied()));
            }
        }
        entries
    }

    /// ∂²f/∂q∂θ or ∂²f/∂v∂θ, column by column.
    fn mixed_with_parameters(&mut self, of: &Derivatives, velocity: bool) -> Vec<Node> {
        let mut entries = Vec::new();
        let parameters: &[Expr] = &self.system.parameters;
        for expression in parameters {
            let b = self.graph.listed(expression);
            for index in 0..self.n {
                let a = self.variable(index, velocity);
                let entry = of.hessian.get(&(a.min(b), a.max(b))).copied();
                entries.push(self.or_zero(entry));
            }
        }
        entries
    }

    /// The Hessian of a·∂f/∂q + b·∂f/∂v.
    fn along_vectors(&mut self, part: Part, root: Node) -> Made<Routine> {
        let gradient = self.derivation.gradient(&mut self.graph, root);
        let mut sum = None;
        for (vector, velocity) in [("a", false), ("b", true)] {
            for index in 0..self.n {
                let variable = self.variable(index, velocity);
                let Some(&slope) = gradient.get(&variable) else { continue };
                let factor = self.graph.entry(vector, index);
                let term = self.graph.times(factor, slope);
                sum = Some(self.added(sum, term));
            }
        }
        let sum = self.or_zero(sum);
        let of = self.derivation.hessian(&mut self.graph, sum, "");
        let outputs = self.blocks(&of);
        self.made(Of::Along(part), self.system.home(), &outputs)
    }

    /// The Hessian of a covector's product with f.
    fn force_along(&mut self, components: &[Node]) -> Made<Routine> {
        let mut sum = None;
        for (index, &component) in components.iter().enumerate() {
            let factor = self.graph.entry("vector", index);
            let term = self.graph.times(factor, component);
            sum = Some(self.added(sum, term));
        }
        let sum = self.or_zero(sum);
        let of = self.derivation.hessian(&mut self.graph, sum, "");
        let mut outputs = self.blocks(&of);
        let mut variables: Vec<Node> =
            (0..2 * self.n).map(|i| self.variable(i % self.n, i >= self.n)).collect();
        let inputs: Vec<Node> = (0..self.m).map(|j| self.graph.node(Operation::Input(j))).collect();
        variables.extend(&inputs);
        for input in inputs {
            for &variable in &variables {
                let entry = of.hessian.get(&(variable.min(input), variable.max(input))).copied();
                outputs.push(self.or_zero(entry));
            }
        }
        self.made(Of::Along(Part::Force), self.system.home(), &outputs)
    }
}
