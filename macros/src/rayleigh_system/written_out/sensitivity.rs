//! Derivatives on request: those by parameters, and the Hessians that second derivatives of the step need.

use syn::Expr;

use super::*;

impl Code<'_> {
    /// The functions of `Parameters`, if there are any.
    pub(super) fn all_by_parameters(
        &mut self,
        lagrangian: Node,
        rayleigh: Option<Node>,
        force: Option<&[Node]>,
    ) -> Written<Option<TokenStream>> {
        if self.system.parameters.is_empty() {
            return Ok(None);
        }
        let of_lagrangian = self.by_parameters(Part::Lagrangian, lagrangian)?;
        let of_rayleigh = rayleigh.map(|root| self.by_parameters(Part::Rayleigh, root)).transpose()?;
        let of_force = force.map(|components| self.force_by_parameters(components)).transpose()?;
        Ok(Some(quote!(#of_lagrangian #of_rayleigh #of_force)))
    }

    /// The functions of `SecondOrder`, if they are asked for.
    pub(super) fn all_along(
        &mut self,
        lagrangian: Node,
        rayleigh: Option<Node>,
        force: Option<&[Node]>,
    ) -> Written<Option<TokenStream>> {
        if !self.system.second {
            return Ok(None);
        }
        let of_lagrangian = self.along_vectors(Part::Lagrangian, lagrangian)?;
        let of_rayleigh = rayleigh.map(|root| self.along_vectors(Part::Rayleigh, root)).transpose()?;
        let of_force = force.map(|components| self.force_along(components)).transpose()?;
        Ok(Some(quote!(#of_lagrangian #of_rayleigh #of_force)))
    }

    /// `lagrangian_by_parameters`, `rayleigh_by_parameters`
    fn by_parameters(&mut self, part: Part, root: Node) -> Written<TokenStream> {
        let scalar = &self.system.scalar;
        let (n, count) = (self.system.degrees.times(1), self.system.parameters.len());
        let p = self.system.parameter_count();
        let function = format_ident!("{}_by_parameters", part.name());
        let of = self.derivation.hessian(&mut self.graph, root, "");
        let outputs: Vec<Node> =
            [false, true].iter().flat_map(|&by| self.mixed_with_parameters(&of, by)).collect();
        let line = self.code(self.system.home(), &outputs)?;
        let (by_q, by_v) = line.outputs.split_at(self.n * count);
        let [d1, d2] = [by_q, by_v].map(|entries| matrix(entries, self.n));
        let (q, v, statements) =
            (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities), &line.statements);
        Ok(quote! {
            #[inline]
            fn #function(&self, #q: &Vector, #v: &Vector) -> GradientBy<#scalar, #n, #p> {
                #statements
                GradientBy { d1: #d1, d2: #d2 }
            }
        })
    }

    /// `force_by_parameters`
    fn force_by_parameters(&mut self, components: &[Node]) -> Written<TokenStream> {
        let scalar = &self.system.scalar;
        let (n, p) = (self.system.degrees.times(1), self.system.parameter_count());
        let rows = self.rows(components);
        let mut outputs = Vec::new();
        for expression in &self.system.parameters {
            let parameter = self.graph.listed(expression);
            for row in &rows {
                outputs.push(self.or_zero(row.get(&parameter).copied()));
            }
        }
        let line = self.code(self.system.home(), &outputs)?;
        let matrix = matrix(&line.outputs, self.n);
        let (q, v, statements) =
            (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities), &line.statements);
        Ok(quote! {
            #[inline]
            fn force_by_parameters(&self, #q: &Vector, #v: &Vector) -> SMatrix<#scalar, #n, #p> {
                #statements
                #matrix
            }
        })
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

    /// `lagrangian_along`, `rayleigh_along`: the Hessian of a·∂f/∂q + b·∂f/∂v.
    fn along_vectors(&mut self, part: Part, root: Node) -> Written<TokenStream> {
        let scalar = &self.system.scalar;
        let (n, m) = (self.system.degrees.times(1), self.system.inputs());
        let function = format_ident!("{}_along", part.name());
        let gradient = self.derivation.gradient(&mut self.graph, root);
        let mut sum = None;
        for (vector, velocity) in [("a", false), ("b", true)] {
            for index in 0..self.n {
                let variable = self.variable(index, velocity);
                let Some(&slope) = gradient.get(&variable) else { continue };
                let factor = self.vector_entry(vector, index);
                let term = self.graph.times(factor, slope);
                sum = Some(self.added(sum, term));
            }
        }
        let sum = self.or_zero(sum);
        let of = self.derivation.hessian(&mut self.graph, sum, "");
        let outputs =
            [self.block(&of, false, false), self.block(&of, false, true), self.block(&of, true, true)];
        let line = self.code_taking(self.system.home(), &outputs.concat(), &["a", "b"])?;
        let [d11, d12, d22] = self.parts(&line.outputs, [Shape::Matrix, Shape::Matrix, Shape::Matrix]);
        let (q, v) = (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities));
        let (a, b, statements) =
            (parameter("a", line.uses("a")), parameter("b", line.uses("b")), &line.statements);
        Ok(quote! {
            #[inline]
            fn #function(
                &self,
                #q: &Vector,
                #v: &Vector,
                #a: &Vector,
                #b: &Vector,
            ) -> Hessian<#scalar, #n, #m> {
                #statements
                Hessian { d11: #d11, d12: #d12, d22: #d22, ..Hessian::zero() }
            }
        })
    }

    /// `force_along`: the Hessian of a covector's product with f.
    fn force_along(&mut self, components: &[Node]) -> Written<TokenStream> {
        let scalar = &self.system.scalar;
        let (n, m) = (self.system.degrees.times(1), self.system.inputs());
        let mut sum = None;
        for (index, &component) in components.iter().enumerate() {
            let factor = self.vector_entry("vector", index);
            let term = self.graph.times(factor, component);
            sum = Some(self.added(sum, term));
        }
        let sum = self.or_zero(sum);
        let of = self.derivation.hessian(&mut self.graph, sum, "");
        let mut outputs =
            [self.block(&of, false, false), self.block(&of, false, true), self.block(&of, true, true)]
                .concat();
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
        let line = self.code_taking(self.system.home(), &outputs, &["vector"])?;
        let squares = 3 * self.n * self.n;
        let [d11, d12, d22] =
            self.parts(&line.outputs[..squares], [Shape::Matrix, Shape::Matrix, Shape::Matrix]);
        let by_input = (self.m > 0).then(|| {
            let columns: Vec<_> = line.outputs[squares..].chunks(2 * self.n + self.m).collect();
            let [d1u, d2u, duu] =
                [0..self.n, self.n..2 * self.n, 2 * self.n..2 * self.n + self.m].map(|rows| {
                    let entries: Vec<_> =
                        columns.iter().flat_map(|column| column[rows.clone()].iter().cloned()).collect();
                    matrix(&entries, rows.len())
                });
            quote!(d1u: #d1u, d2u: #d2u, duu: #duu)
        });
        let by_input = by_input.unwrap_or_else(|| quote!(..Hessian::zero()));
        let (q, v) = (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities));
        let (vector, statements) = (parameter("vector", line.uses("vector")), &line.statements);
        Ok(quote! {
            #[inline]
            fn force_along(&self, #q: &Vector, #v: &Vector, #vector: &Vector) -> Hessian<#scalar, #n, #m> {
                #statements
                Hessian { d11: #d11, d12: #d12, d22: #d22, #by_input }
            }
        })
    }

    /// `a[0]`
    pub(super) fn vector_entry(&mut self, vector: &str, index: usize) -> Node {
        self.graph.entry(vector, index)
    }
}
