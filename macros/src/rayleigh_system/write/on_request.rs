//! Traits implemented on request: derivatives by the input and by parameters, and second ones.

use proc_macro2::TokenStream;
use quote::quote;

use super::super::model::{Home, System};
use super::view::{parameter_names, subject};

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
    let names = parameter_names(system);
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
    let by_input = system.input.is_some().then(|| {
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
    }
}
