//! The user's functions, each handing its work to its twin over dual numbers, and the twins.

use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};
use syn::{FnArg, ImplItem, ImplItemFn, ItemImpl, Pat, Receiver, Type, parse_quote};

use super::super::model::{Function, System};
use super::super::syntax::has_floats;
use super::super::write::item::{lints, structure};
use super::rewrite::{Twin, over};

/// The user's block, each differentiated function handing its work to the twin.
pub fn plain_block(system: &System<'_>, block: &ItemImpl, twins: &[Twin]) -> TokenStream {
    let mut block = block.clone();
    for item in &mut block.items {
        if let ImplItem::Fn(function) = item
            && twins.iter().any(|twin| twin.plain.sig.ident == function.sig.ident)
        {
            plain(system, function);
        }
    }
    block.into_token_stream()
}

/// The differentiated functions over `Real<D>`, in the order of the block.
pub fn twins_of_block(system: &System<'_>, block: &ItemImpl, twins: &[Twin]) -> TokenStream {
    let name = &system.name;
    let attributes = lints(&block.attrs);
    let twins = system.source.functions().filter_map(|function| {
        let twin = twins.iter().find(|twin| twin.plain.sig.ident == function.sig.ident)?;
        Some(written(twin, is_root(function)))
    });
    // Where nobody makes a value of the type, rustc says so at the type; the twins add nothing to that.
    quote! {
        #(#attributes)*
        #[allow(dead_code)]
        impl #name { #(#twins)* }
    }
}

/// `fn height(&self, x: f64) -> f64 { use ::dalembert::generated::dual;
/// dual::lower(self.height_over::<f64>(dual::lift(x))) }`
fn plain(system: &System<'_>, function: &mut ImplItemFn) {
    let scalar = &system.scalar;
    let name = over(&function.sig.ident);
    // The user's own `self`: one of the macro's would be another variable where a `macro_rules!` wrote the
    // attribute.
    let callee = match function.sig.receiver() {
        Some(Receiver { self_token, .. }) => quote!(#self_token.#name::<#scalar>),
        None => quote!(Self::#name::<#scalar>),
    };
    let arguments = lifted_arguments(function.sig.inputs.iter_mut());
    function.attrs.retain(|attribute| !attribute.path().is_ident("expect"));
    function.attrs.push(parse_quote!(#[allow(clippy::used_underscore_binding)]));
    // Bodies call the twins: a private helper may have no other caller.
    if !is_root(function) {
        function.attrs.push(parse_quote!(#[allow(dead_code)]));
    }
    function.block = parse_quote!({
        use ::dalembert::generated::dual;
        dual::lower(#callee(#(#arguments),*))
    });
}

/// The arguments of the twin; patterns that are no plain name become one.
fn lifted_arguments<'p>(parameters: impl Iterator<Item = &'p mut FnArg>) -> Vec<TokenStream> {
    parameters
        .enumerate()
        .filter_map(|(index, parameter)| match parameter {
            FnArg::Receiver(_) => None,
            FnArg::Typed(parameter) => {
                let name = match &*parameter.pat {
                    Pat::Ident(pattern) => pattern.ident.clone(),
                    _ => format_ident!("argument_{index}"),
                };
                // The twin alone changes a `mut` parameter.
                *parameter.pat = parse_quote!(#name);
                Some(match &*parameter.ty {
                    ty if !has_floats(ty) => quote!(#name),
                    Type::Reference(_) => quote!(&dual::lift(*#name)),
                    _ => quote!(dual::lift(#name)),
                })
            }
        })
        .collect()
}

/// Whether the function is L, R, f or σ, and not a helper that they call.
fn is_root(function: &ImplItemFn) -> bool {
    ["lagrangian", "rayleigh", "force", "time_scale"].iter().any(|root| function.sig.ident == root)
}

/// The function over `Real<D>`, with the lint levels that the user set for its body.
pub fn written(twin: &Twin, is_root: bool) -> TokenStream {
    let Twin { plain, over, .. } = twin;
    let text = format!(" `{}` over plain and dual numbers.", plain.sig.ident);
    let attributes = lints(&plain.attrs);
    // L, R and f are called from one closure for each kind of number: called, they would hide from the
    // compiler which derivatives are absent.
    let inline = if is_root { quote!(#[inline(always)]) } else { quote!(#[inline]) };
    quote! {
        #[doc = #text]
        #inline
        #(#attributes)*
        #over
    }
}

/// The user's function, callable as before, and the struct of its parameters.
pub fn function_and_struct(system: &System<'_>, function: &Function) -> TokenStream {
    let name = &system.name;
    let mut plain = function.item.clone();
    let scalar = &system.scalar;
    let twin = over(&function.item.sig.ident);
    let arguments = lifted_arguments(plain.sig.inputs.iter_mut());
    plain.attrs.retain(|attribute| !attribute.path().is_ident("expect"));
    plain.block = parse_quote!({
        use ::dalembert::generated::dual;
        dual::lower(#name::#twin::<#scalar>(#(#arguments),*))
    });
    let structure = structure(system, function);
    quote! {
        #plain

        #structure
    }
}

/// The function's twin, and L and R taken out of it.
pub fn twins_of_function(system: &System<'_>, function: &Function, twin: &Twin) -> TokenStream {
    let System { name, scalar, .. } = system;
    let n = system.degrees.times(1);
    let twin_name = &twin.over.sig.ident;
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
    let of_pair = system.rayleigh.is_some();
    let lagrangian = part("lagrangian", " L over plain and dual numbers.", of_pair.then(|| quote!(0)));
    let rayleigh = of_pair
        .then(|| part("rayleigh", " The Rayleigh function over plain and dual numbers.", Some(quote!(1))));
    quote! {
        #[allow(dead_code)]
        impl #name {
            #twin
            #lagrangian
            #rayleigh
        }
    }
}
