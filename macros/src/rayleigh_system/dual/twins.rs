//! The twins over dual numbers of the user's functions. Those stand as written, and are what the twins are
//! compared with.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::ImplItemFn;

use super::super::model::{Function, System};
use super::super::parts::Part;
use super::super::write::item::conditions_of;
use super::rewrite::{OwnMethods, Twin};

/// The differentiated functions over `Real<D>`, in the order of the block.
pub fn twins_of_block(system: &System<'_>, twins: &[Twin]) -> TokenStream {
    let name = &system.name;
    let mut own_methods = OwnMethods::default();
    twins.iter().for_each(|twin| own_methods.extend(&twin.own_methods));
    let told = own_methods.told();
    let twins = system.source.functions().filter_map(|function| {
        let twin = twins.iter().find(|twin| twin.plain.sig.ident == function.sig.ident)?;
        Some(written(twin, is_root(function)))
    });
    // Where nobody makes a value of the type, rustc says so at the type; the twins add nothing to that.
    quote! {
        #told

        #[allow(dead_code)]
        impl #name { #(#twins)* }
    }
}

/// Whether the function is L, R, f or σ, and not a helper that they call.
fn is_root(function: &ImplItemFn) -> bool {
    ["lagrangian", "rayleigh", "force", "time_scale"].iter().any(|root| function.sig.ident == root)
}

/// The function over `Real<D>`.
pub fn written(twin: &Twin, is_root: bool) -> TokenStream {
    let Twin { plain, over, .. } = twin;
    let text = format!(" `{}` over plain and dual numbers.", plain.sig.ident);
    let conditions = conditions_of(&plain.attrs);
    // L, R and f are called from one closure for each kind of number: called, they would hide from the
    // compiler which derivatives are absent.
    let inline = if is_root { quote!(#[inline(always)]) } else { quote!(#[inline]) };
    quote! {
        #[doc = #text]
        #inline
        #(#conditions)*
        #over
    }
}

/// The function's twin, and L and R taken out of it.
pub fn twins_of_function(system: &System<'_>, function: &Function, twin: &Twin) -> TokenStream {
    let System { name, scalar, .. } = system;
    let n = system.degrees.times(1);
    let twin_name = &twin.over.sig.ident;
    let told = twin.own_methods.told();
    let twin = written(twin, true);
    let lifted: Vec<_> = function.fields().map(|(field, _)| quote!(D::lift(self.#field))).collect();
    let part = |name: &str, text: &str, index: Option<TokenStream>| {
        let name = format_ident!("{name}_over");
        let index = index.map(|index| quote!(.#index));
        // fn lagrangian_over<D: Dual<f64>>(&self, q: …, v: …) -> Real<D> { Self::oscillator_over(q, v,
        // D::lift(self.m)).0 }
        quote! {
            #[doc = #text]
            #[inline(always)]
            fn #name<D: Dual<#scalar>>(&self, q: [Real<D>; #n], v: [Real<D>; #n]) -> Real<D> {
                Self::#twin_name(q, v, #(#lifted),*) #index
            }
        }
    };
    let of_pair = system.has(Part::Rayleigh);
    let lagrangian = part("lagrangian", " L over plain and dual numbers.", of_pair.then(|| quote!(0)));
    let rayleigh = of_pair
        .then(|| part("rayleigh", " The Rayleigh function over plain and dual numbers.", Some(quote!(1))));
    quote! {
        #told

        #[allow(dead_code)]
        impl #name {
            #twin
            #lagrangian
            #rayleigh
        }
    }
}
