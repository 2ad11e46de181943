//! Kinks of R as functions: `DryFriction`.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::super::model::System;
use super::view::subject;

/// The kinks of R as an engine writes them.
pub struct Friction {
    /// How many components each element has.
    pub sizes: Vec<usize>,
    /// Whether no coordinate stands in them.
    pub is_uniform: bool,
    /// Whether R is proportional to each length.
    pub is_proportional: bool,
    pub functions: TokenStream,
    /// Derivatives by parameters, if they are asked for.
    pub by_parameters: Option<TokenStream>,
    /// R without its kinks, if anything is left of it.
    pub smooth: Option<TokenStream>,
}

impl Friction {
    /// The number of all components.
    pub fn components(&self) -> Literal {
        Literal::usize_unsuffixed(self.sizes.iter().sum())
    }
}

/// `impl SmoothRayleigh<2> for Ring` and `impl DryFriction<2, 1> for Ring`, and `impl
/// DryFrictionParameters<2, 1, 3> for Ring` where parameters are listed.
pub fn dry_friction(system: &System<'_>, friction: &Friction) -> TokenStream {
    let Friction { sizes, is_uniform, is_proportional, functions, by_parameters, smooth } = friction;
    let (n, m) = (system.degrees.times(1), friction.components());
    let sizes = sizes.iter().map(|size| Literal::usize_unsuffixed(*size));
    let subject = subject(system, system.home());
    let smooth = smooth.as_ref().map(|function| {
        quote! {
            const HAS_SMOOTH: bool = true;

            #function
        }
    });
    let by_parameters = by_parameters.as_ref().map(|function| {
        let p = system.parameter_count();
        quote! {
            #[automatically_derived]
            impl ::dalembert::generated::DryFrictionParameters<#n, #m, #p> for #subject {
                #function
            }
        }
    });
    quote! {
        #[automatically_derived]
        impl ::dalembert::generated::SmoothRayleigh<#n> for #subject {
            #smooth
        }

        #[automatically_derived]
        impl ::dalembert::generated::DryFriction<#n, #m> for #subject {
            const ELEMENTS: &'static [usize] = &[#(#sizes),*];
            const IS_UNIFORM: bool = #is_uniform;
            const IS_PROPORTIONAL: bool = #is_proportional;

            #functions
        }

        #by_parameters
    }
}
