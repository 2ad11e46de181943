//! Steps of several members at once: their fields gathered, and the functions of each kind of lanes.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::super::model::System;
use super::view::subject;

/// The functions of the traits in lanes, as an engine makes them.
pub struct LaneFunctions {
    /// `type Fields` and the functions that fill it.
    pub gathered: TokenStream,
    pub explicit: Option<TokenStream>,
    pub midpoint: Option<TokenStream>,
    /// Of the stages of Gauss rules.
    pub stages: Option<TokenStream>,
}

/// `impl Gathered<2> for Ring`, and an `impl` for each kind of lanes that is asked for.
pub fn in_lanes(system: &System<'_>, functions: LaneFunctions) -> TokenStream {
    let LaneFunctions { gathered, explicit, midpoint, stages } = functions;
    let (subject, n) = (subject(system, system.home()), system.degrees.times(1));
    let rule = quote!(::dalembert::generated::Midpoint,);
    let of_each = [
        ("Gathered", None, Some(gathered)),
        ("ExplicitInLanes", None, explicit),
        ("DiscreteInLanes", Some(rule), midpoint),
        ("ForcedLagrangianInLanes", None, stages),
    ];
    of_each
        .into_iter()
        .filter_map(|(name, rule, functions)| {
            let name = format_ident!("{name}");
            functions.map(|functions| {
                quote! {
                    #[automatically_derived]
                    impl ::dalembert::generated::#name<#rule #n> for #subject {
                        #functions
                    }
                }
            })
        })
        .collect()
}
