//! Gradients and second derivatives of L and R, derivatives of f.

use super::*;

impl Code<'_> {
    /// Gradient and derivatives of L or R, and variations where they are asked for.
    pub(super) fn function(&mut self, part: Part, symbol: &str, root: Node) -> Written<TokenStream> {
        let scalar = &self.system.scalar;
        let n = self.system.degrees.times(1);
        let [gradient, derivatives] =
            ["gradient", "derivatives"].map(|kind| format_ident!("{}_{kind}", part.name()));
        let home = self.system.home_of(part);
        let first = self.derivation.gradient(&mut self.graph, root);
        let second = self.derivation.hessian(&mut self.graph, root, symbol);

        let outputs = [vec![root], self.covector(&first, false), self.covector(&first, true)];
        let line = self.code(home, &outputs.concat())?;
        let [value_of, d1, d2] = self.parts(&line.outputs, [Shape::Scalar, Shape::Vector, Shape::Vector]);
        let (q, v, statements) =
            (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities), &line.statements);
        let inline = inlined(statements);
        let gradient = quote! {
            #inline
            fn #gradient(&self, #q: &Vector, #v: &Vector) -> Gradient<#scalar, #n> {
                #statements
                Gradient { value: #value_of, d1: #d1, d2: #d2 }
            }
        };

        let outputs = [
            vec![root],
            self.covector(&second.gradient, false),
            self.covector(&second.gradient, true),
            self.block(&second, false, false),
            self.block(&second, false, true),
            self.block(&second, true, true),
        ];
        let line = self.code(home, &outputs.concat())?;
        let [value_of, d1, d2, d11, d12, d22] = self.parts(
            &line.outputs,
            [Shape::Scalar, Shape::Vector, Shape::Vector, Shape::Matrix, Shape::Matrix, Shape::Matrix],
        );
        let (q, v, statements) =
            (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities), &line.statements);
        let inline = inlined(statements);
        let derivatives = quote! {
            #inline
            fn #derivatives(&self, #q: &Vector, #v: &Vector) -> Derivatives<#scalar, #n> {
                #statements
                Derivatives { value: #value_of, d1: #d1, d2: #d2, d11: #d11, d12: #d12, d22: #d22 }
            }
        };

        let variations = (part == Part::Lagrangian && self.system.rules.ask_for_variations())
            .then(|| self.variations(&second))
            .transpose()?;
        Ok(quote! {
            #gradient

            #derivatives

            #variations
        })
    }

    /// Derivatives of f.
    pub(super) fn force(&mut self, components: &[Node]) -> Written<TokenStream> {
        let scalar = &self.system.scalar;
        let n = self.system.degrees.times(1);
        let rows = self.rows(components);
        let by = |code: &mut Self, velocity| {
            code.matrix(|code, i, j| {
                let variable = code.variable(j, velocity);
                rows[i].get(&variable).copied()
            })
        };
        let outputs = [components.to_vec(), by(self, false), by(self, true)].concat();
        let line = self.code(self.system.home(), &outputs)?;
        let [value, d1, d2] = self.parts(&line.outputs, [Shape::Vector, Shape::Matrix, Shape::Matrix]);
        let (q, v, statements) =
            (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities), &line.statements);
        let inline = inlined(statements);
        Ok(quote! {
            #inline
            fn force_derivatives(&self, #q: &Vector, #v: &Vector) -> CovectorDerivatives<#scalar, #n> {
                #statements
                CovectorDerivatives { value: #value, d1: #d1, d2: #d2 }
            }
        })
    }

    /// σ and ∇σ.
    pub(super) fn time_scale(&mut self, root: Node) -> Written<TokenStream> {
        let scalar = &self.system.scalar;
        let gradient = self.derivation.gradient(&mut self.graph, root);
        let outputs = [vec![root], self.covector(&gradient, false)];
        let line = self.code(self.system.home(), &outputs.concat())?;
        let [value, gradient] = self.parts(&line.outputs, [Shape::Scalar, Shape::Vector]);
        let (q, statements) = (parameter("q", line.uses_coordinates), &line.statements);
        Ok(quote! {
            fn time_scale_gradient(&self, #q: &Vector) -> (#scalar, Vector) {
                #statements
                (#value, #gradient)
            }
        })
    }

    /// `force_by_input`
    pub(super) fn by_input(&mut self, components: &[Node], input: &Degrees) -> Written<TokenStream> {
        let scalar = &self.system.scalar;
        let (n, m) = (self.system.degrees.times(1), input.times(1));
        let rows = self.rows(components);
        let mut outputs = Vec::new();
        for j in 0..self.m {
            let variable = self.graph.node(Operation::Input(j));
            for row in &rows {
                outputs.push(self.or_zero(row.get(&variable).copied()));
            }
        }
        let line = self.code(self.system.home(), &outputs)?;
        let matrix = matrix(&line.outputs, self.n);
        let (q, v, statements) =
            (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities), &line.statements);
        Ok(quote! {
            #[inline]
            fn force_by_input(&self, #q: &Vector, #v: &Vector) -> SMatrix<#scalar, #n, #m> {
                #statements
                #matrix
            }
        })
    }
}
