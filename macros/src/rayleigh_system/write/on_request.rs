//! Traits implemented on request: derivatives by the input and by parameters, and second ones.

use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};

use super::super::model::{Home, System};
use super::view::subject;

/// `impl Driven<2, 1> for DrivenArm<'_>`, with the body of either engine.
pub fn driven(system: &System<'_>, by_input: TokenStream) -> Option<TokenStream> {
    let (n, m) = (system.degrees.times(1), system.input.as_ref()?.times(1));
    let subject = subject(system, Home::View);
    Some(quote! {
        #[automatically_derived]
        impl Driven<#n, #m> for #subject {
            #by_input
        }
    })
}

/// `impl Parameters<2, 3> for Ring`, with the functions given.
pub fn by_parameters(system: &System<'_>, functions: TokenStream) -> TokenStream {
    let (n, p) = (system.degrees.times(1), system.parameter_count());
    let subject = subject(system, system.home());
    let names =
        system.parameters.iter().map(|parameter| parameter.to_token_stream().to_string().replace(' ', ""));
    quote! {
        #[automatically_derived]
        impl Parameters<#n, #p> for #subject {
            const PARAMETERS: [&'static str; #p] = [#(#names),*];

            #functions
        }
    }
}

/// `impl SecondOrder<2, 1> for DrivenArm<'_>`, with the functions of either engine.
pub fn second_order(system: &System<'_>, functions: TokenStream) -> TokenStream {
    let scalar = &system.scalar;
    let (n, m) = (system.degrees.times(1), system.inputs());
    let subject = subject(system, system.home());
    let terms: Vec<_> = system.parts().map(|part| format_ident!("{}_along", part.name())).collect();
    let rules = system.rules.of_displacement.iter().map(|rule| rule.ident());
    let discrete = rules.map(|rule| {
        let p0_by_input = system.input.is_some().then(|| {
            quote! {
                #[automatically_derived]
                impl StartByInput<#rule, #n, #m> for #subject {
                    /// −∂f_d⁻/∂u.
                    fn p0_by_input(&self, q0: &Vector, v: &Vector, h: #scalar) -> SMatrix<#scalar, #n, #m> {
                        #rule::force_by_input(self, q0, v, h).p0
                    }
                }
            }
        });
        quote! {
            #[automatically_derived]
            impl DiscreteSecondOrder<#rule, #n, #m> for #subject {
                /// Second derivatives of `at_start`·p0 + `at_end`·p1 by q0, q1 and u.
                fn momenta_along(
                    &self,
                    q0: &Vector,
                    v: &Vector,
                    h: #scalar,
                    at_start: &Vector,
                    at_end: &Vector,
                ) -> Hessian<#scalar, #n, #m> {
                    #(#rule::#terms(self, q0, v, h, [at_start, at_end]))+*
                }
            }

            #p0_by_input
        }
    });
    // What rules with interior points ask for besides.
    let by_input = (system.rules.gauss && system.input.is_some()).then(|| {
        quote! {
            #[inline]
            fn force_slope_by_input(&self, q: &Vector, v: &Vector) -> SMatrix<#scalar, #n, #m> {
                self.force_by_input(q, v)
            }
        }
    });
    quote! {
        #[automatically_derived]
        impl SecondOrder<#n, #m> for #subject {
            #functions
            #by_input
        }

        #(#discrete)*
    }
}
