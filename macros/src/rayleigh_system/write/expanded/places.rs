//! Operations of L, R, f and constraints that have no derivative at some arguments, for the errors of steps.

use super::super::super::derived::Places;
use super::*;

impl Text<'_> {
    /// `Lagrangian::place_without_derivative`; nothing where no operation can lack a derivative.
    pub(super) fn places(&self, all: &[Places]) -> Option<TokenStream> {
        let (mut uses_coordinates, mut uses_velocities) = (false, false);
        let mut arms = Vec::new();
        for Places { part, index, places, arguments } in all {
            let line = self.line_at_present(arguments);
            uses_coordinates |= line.uses_coordinates;
            uses_velocities |= line.uses_velocities;
            let mut values = line.outputs.iter();
            let places = places.iter().filter_map(|place| {
                let (name, text, s) = (format_ident!("{}", place.name), &place.text, values.next()?);
                let second = if place.has_second { values.next()?.clone() } else { quote!(0.0) };
                let written = quote! {
                    &::dalembert::generated::Written {
                        operation: ::dalembert::generated::Operation::#name,
                        text: #text,
                    }
                };
                Some(quote!((#written, [#s, #second])))
            });
            let index = Literal::usize_unsuffixed(*index);
            let function = match part {
                Part::Lagrangian => quote!(Lagrangian),
                Part::Rayleigh => quote!(Rayleigh),
                Part::Force => quote!(Force { index: #index }),
                Part::TimeScale => quote!(TimeScale),
                Part::Constraints | Part::VelocityConstraints | Part::Events | Part::Outputs => {
                    quote!(Constraint { index: #index })
                }
            };
            let statements = &line.statements;
            arms.push(quote! {
                ::dalembert::generated::Function::#function => {
                    #statements
                    ::dalembert::generated::Place::first(&[#(#places),*])
                }
            });
        }
        if arms.is_empty() {
            return None;
        }
        let (q, v) = (parameter("q", uses_coordinates), parameter("v", uses_velocities));
        Some(quote! {
            /// The first operation that has no derivative there, as √s at s = 0.
            #[cold]
            fn place_without_derivative(
                &self,
                function: ::dalembert::generated::Function,
                #q: &Vector,
                #v: &Vector,
            ) -> ::core::option::Option<::dalembert::generated::Place> {
                match function {
                    #(#arms)*
                    _ => ::core::option::Option::None,
                }
            }
        })
    }
}
