//! Functions at (q, v): derivatives of L, R, f, σ and constraints.

use super::matrices::matrix;
use super::*;

impl Text<'_> {
    /// The functions that are asked for; nothing where there is none.
    pub(super) fn functions_of(&self, is_asked: impl Fn(Of) -> bool) -> Option<TokenStream> {
        let asked = self.derived.functions.iter().filter(|function| is_asked(function.of));
        let written: Vec<TokenStream> = asked.map(|function| self.function(function)).collect();
        (!written.is_empty()).then(|| quote!(#(#written)*))
    }

    fn function(&self, function: &Routine) -> TokenStream {
        use Shape::{Matrix, Scalar, Vector};
        let line = self.line_at_present(function);
        let (outputs, statements) = (&line.outputs, &line.statements);
        let (scalar, n, m, p, constraints) = (
            &self.system.scalar,
            self.system.degrees.times(1),
            self.system.inputs(),
            self.system.parameter_count(),
            self.system.constraint_count(),
        );
        let inline = Some(quote!(#[inline]));
        let (attributes, name, ty, result) = match function.of {
            Of::Gradient(part) => {
                let [value, d1, d2] = self.parts(outputs, [Scalar, Vector, Vector]);
                let result = quote!(Gradient { value: #value, d1: #d1, d2: #d2 });
                let name = format!("{}_gradient", part.name());
                (inlined(statements), name, quote!(Gradient<#scalar, #n>), result)
            }
            Of::Derivatives(_) | Of::SmoothRayleigh => {
                let [value, d1, d2, d11, d12, d22] =
                    self.parts(outputs, [Scalar, Vector, Vector, Matrix, Matrix, Matrix]);
                let result = quote! {
                    Derivatives { value: #value, d1: #d1, d2: #d2, d11: #d11, d12: #d12, d22: #d22 }
                };
                let name = match function.of {
                    Of::Derivatives(part) => format!("{}_derivatives", part.name()),
                    _ => "smooth_rayleigh_derivatives".to_owned(),
                };
                (inlined(statements), name, quote!(Derivatives<#scalar, #n>), result)
            }
            Of::Variations => {
                let [minus, plus, mixed] = self.parts(outputs, [Vector, Vector, Matrix]);
                let result = quote!(Variations { minus: #minus, plus: #plus, mixed: #mixed });
                (inline, "lagrangian_variations".to_owned(), quote!(Variations<#scalar, #n>), result)
            }
            Of::ForceDerivatives => {
                let [value, d1, d2] = self.parts(outputs, [Vector, Matrix, Matrix]);
                let result = quote!(CovectorDerivatives { value: #value, d1: #d1, d2: #d2 });
                let ty = quote!(CovectorDerivatives<#scalar, #n>);
                (inlined(statements), "force_derivatives".to_owned(), ty, result)
            }
            Of::TimeScaleGradient => {
                let [value, gradient] = self.parts(outputs, [Scalar, Vector]);
                let ty = quote!((#scalar, Vector));
                (None, "time_scale_gradient".to_owned(), ty, quote!((#value, #gradient)))
            }
            Of::ConstraintGradients => {
                let count = outputs.len() / (self.derived.n + 1);
                let (values, gradients) = outputs.split_at(count);
                let gradients = matrix(gradients, count);
                let ty = quote!((SVector<#scalar, #constraints>, SMatrix<#scalar, #constraints, #n>));
                let result = quote!((SVector::from([#(#values),*]), #gradients));
                (inlined(statements), "constraint_gradients".to_owned(), ty, result)
            }
            Of::ConstraintRounding => {
                let attributes = quote! {
                    /// The rounding of g, over ε: a running error bound.
                    #[cold]
                };
                let ty = quote!(SVector<#scalar, #constraints>);
                let result = quote!(SVector::from([#(#outputs),*]));
                (Some(attributes), "constraint_rounding".to_owned(), ty, result)
            }
            Of::ConstraintRates => {
                let count = outputs.len() / (self.derived.n + 1);
                let (rates, by_q) = outputs.split_at(count);
                let by_q = matrix(by_q, count);
                let ty = quote!((SVector<#scalar, #constraints>, SMatrix<#scalar, #constraints, #n>));
                (inline, "constraint_rates".to_owned(), ty, quote!((SVector::from([#(#rates),*]), #by_q)))
            }
            Of::ConstraintsByParameters => {
                let count = (outputs.len() / self.system.parameters.len() - self.derived.n) / 2;
                let (values, others) = outputs.split_at(count * self.system.parameters.len());
                let (rates, reaction) = others.split_at(values.len());
                let [values, rates] = [values, rates].map(|entries| matrix(entries, count));
                let reaction = matrix(reaction, self.derived.n);
                let ty = quote!(::dalembert::generated::ConstraintsBy<#scalar, #n, #constraints, #p>);
                let result = quote! {
                    ::dalembert::generated::ConstraintsBy { values: #values, rates: #rates, reaction: #reaction }
                };
                (None, "constraints_by_parameters".to_owned(), ty, result)
            }
            Of::ConstraintCurvature => {
                let ty = quote!(SMatrix<#scalar, #n, #n>);
                (None, "constraint_curvature".to_owned(), ty, matrix(outputs, self.derived.n))
            }
            Of::Slips => {
                let count = outputs.len() / (2 + 2 * self.derived.n);
                let (values, others) = outputs.split_at(count);
                let (by_velocity, others) = others.split_at(count * self.derived.n);
                let (by_configuration, limits) = others.split_at(count * self.derived.n);
                let [by_velocity, by_configuration] =
                    [by_velocity, by_configuration].map(|entries| matrix(entries, count));
                let count = Literal::usize_unsuffixed(count);
                let ty = quote!(::dalembert::generated::Slips<#scalar, #n, #count>);
                let result = quote! {
                    ::dalembert::generated::Slips {
                        values: SVector::from([#(#values),*]),
                        by_velocity: #by_velocity,
                        by_configuration: #by_configuration,
                        limits: SVector::from([#(#limits),*]),
                    }
                };
                (inline, "slips".to_owned(), ty, result)
            }
            Of::SlipCurvature => {
                let ty = quote!(SMatrix<#scalar, #n, #n>);
                (None, "slip_curvature".to_owned(), ty, matrix(outputs, self.derived.n))
            }
            Of::SlipsByParameters => {
                let count = self.derived.kinks.components();
                let (values, force) = outputs.split_at(count * self.system.parameters.len());
                let (values, force) = (matrix(values, count), matrix(force, self.derived.n));
                let count = Literal::usize_unsuffixed(count);
                let ty = quote!(::dalembert::generated::SlipsBy<#scalar, #n, #count, #p>);
                let result = quote!(::dalembert::generated::SlipsBy { values: #values, force: #force });
                (None, "slips_by_parameters".to_owned(), ty, result)
            }
            Of::ForceByInput => {
                let ty = quote!(SMatrix<#scalar, #n, #m>);
                (inline, "force_by_input".to_owned(), ty, matrix(outputs, self.derived.n))
            }
            Of::ByParameters(Part::Force) => {
                let ty = quote!(SMatrix<#scalar, #n, #p>);
                (inline, "force_by_parameters".to_owned(), ty, matrix(outputs, self.derived.n))
            }
            Of::ByParameters(part) => {
                let (by_q, by_v) = outputs.split_at(outputs.len() / 2);
                let [d1, d2] = [by_q, by_v].map(|entries| matrix(entries, self.derived.n));
                let ty = quote!(GradientBy<#scalar, #n, #p>);
                let result = quote!(GradientBy { d1: #d1, d2: #d2 });
                (inline, format!("{}_by_parameters", part.name()), ty, result)
            }
            Of::Along(part) => {
                let squares = 3 * self.derived.n * self.derived.n;
                let [d11, d12, d22] = self.parts(&outputs[..squares], [Matrix, Matrix, Matrix]);
                let by_input = self.hessian_by_input(&outputs[squares..]);
                let result = quote!(Hessian { d11: #d11, d12: #d12, d22: #d22, #by_input });
                (inline, format!("{}_along", part.name()), quote!(Hessian<#scalar, #n, #m>), result)
            }
            Of::CancellingTerms => {
                let [momentum, rate] = self.parts(outputs, [Vector, Vector]);
                let attributes = quote! {
                    /// Sizes of the terms that cancel in ∂L/∂v and in ∂L/∂q + f_L, at rest for instance.
                    #[cold]
                };
                let ty = quote!(::dalembert::generated::CancellingTerms<#scalar, #n>);
                let result =
                    quote!(::dalembert::generated::CancellingTerms { momentum: #momentum, rate: #rate });
                (Some(attributes), "cancelling_terms".to_owned(), ty, result)
            }
            // Written elsewhere, with others.
            _ => return TokenStream::new(),
        };
        let (name, q) = (format_ident!("{name}"), parameter("q", line.uses_coordinates));
        let of_configuration = matches!(
            function.of,
            Of::TimeScaleGradient
                | Of::ConstraintGradients
                | Of::ConstraintCurvature
                | Of::ConstraintRounding
                | Of::SlipCurvature
        );
        let v = (!of_configuration).then(|| {
            let v = parameter("v", line.uses_velocities);
            quote!(, #v: &Vector)
        });
        let further: (&[&str], _) = match function.of {
            Of::Variations => (&["minus", "plus"], quote!(Direction<#scalar>)),
            Of::ConstraintCurvature | Of::ConstraintsByParameters => {
                (&["lambda"], quote!(&SVector<#scalar, #constraints>))
            }
            Of::SlipCurvature | Of::SlipsByParameters => {
                let count = Literal::usize_unsuffixed(self.derived.kinks.components());
                (&["forces"], quote!(&SVector<#scalar, #count>))
            }
            Of::Along(Part::Force) => (&["vector"], quote!(&Vector)),
            Of::Along(_) => (&["a", "b"], quote!(&Vector)),
            _ => (&[], quote!()),
        };
        let (names, of) = (further.0.iter().map(|name| parameter(name, line.uses(name))), further.1);
        quote! {
            #attributes
            fn #name(&self, #q: &Vector #v #(, #names: #of)*) -> #ty {
                #statements
                #result
            }
        }
    }

    /// The blocks of a Hessian with u, of columns by (q, v, u).
    fn hessian_by_input(&self, entries: &[TokenStream]) -> TokenStream {
        if entries.is_empty() {
            return quote!(..Hessian::zero());
        }
        let (n, m) = (self.derived.n, self.derived.m);
        let columns: Vec<_> = entries.chunks(2 * n + m).collect();
        let [d1u, d2u, duu] = [0..n, n..2 * n, 2 * n..2 * n + m].map(|rows| {
            let entries: Vec<_> =
                columns.iter().flat_map(|column| column[rows.clone()].iter().cloned()).collect();
            matrix(&entries, rows.len())
        });
        quote!(d1u: #d1u, d2u: #d2u, duu: #duu)
    }
}
