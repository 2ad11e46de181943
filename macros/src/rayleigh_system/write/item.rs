//! The user's item, written again: its attributes and conditions, the struct of a function's parameters, and
//! what stands beside either engine's implementation.

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, quote, quote_spanned};
use syn::{AttrStyle, Attribute, Ident};

use super::super::diagnostics::span_of;
use super::super::model::{Function, Role, Source, System};
use super::super::portable;

/// The user's item, with the struct of a free function.
pub fn as_written(system: &System<'_>, functions: &[Ident], is_portable: bool) -> TokenStream {
    match system.source {
        Source::Block(block) if is_portable => portable::block(&block.item, functions).to_token_stream(),
        Source::Block(block) => block.item.to_token_stream(),
        Source::Function(function) => {
            let structure = structure(system, function);
            let item = if is_portable { &portable::function(&function.item) } else { &function.item };
            quote!(#item #structure)
        }
    }
}

/// The struct of a free function's parameters.
pub fn structure(system: &System<'_>, function: &Function) -> TokenStream {
    let name = &system.name;
    let visibility = function.visibility();
    let function_name = &function.item.sig.ident;
    let what = match function.role {
        Role::System => "mechanical system",
        Role::Field => "field",
    };
    let text = format!(" The {what} of [`{function_name}`], with its parameters.");
    let fields = function.fields().map(|(field, ty)| {
        let text = format!(" Parameter `{field}` of [`{function_name}`].");
        quote!(#[doc = #text] #visibility #field: #ty)
    });
    let body = if function.fields().next().is_some() { quote!({ #(#fields),* }) } else { quote!(;) };
    let conditions = conditions(system.source);
    quote! {
        #(#conditions)*
        #[doc = #text]
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(dead_code)]
        #visibility struct #name #body
    }
}

/// The conditions under which the user's item exists at all.
pub fn conditions(source: &Source) -> Vec<Attribute> {
    let attributes = match source {
        Source::Block(block) => &block.item.attrs,
        Source::Function(function) => &function.item.attrs,
    };
    conditions_of(attributes).collect()
}

/// The conditions among the attributes.
pub fn conditions_of(attributes: &[Attribute]) -> impl Iterator<Item = Attribute> {
    named(attributes, &["cfg"])
}

/// The lint levels that the user's item sets.
pub fn lint_levels(source: &Source) -> Vec<Attribute> {
    let attributes = match source {
        Source::Block(block) => &block.item.attrs,
        Source::Function(function) => &function.item.attrs,
    };
    named(attributes, &["allow", "warn", "deny", "forbid"]).collect()
}

/// Attributes of these names, as outer ones.
fn named(attributes: &[Attribute], names: &[&str]) -> impl Iterator<Item = Attribute> {
    let is_named = |attribute: &&Attribute| names.iter().any(|name| attribute.path().is_ident(name));
    attributes
        .iter()
        .filter(is_named)
        .map(|attribute| Attribute { style: AttrStyle::Outer, ..attribute.clone() })
}

/// No lint of style speaks of generated code, nor of the user's patterns a second time.
pub fn quiet() -> TokenStream {
    quote! {
        #[allow(
            clippy::all,
            clippy::pedantic,
            clippy::nursery,
            nonstandard_style,
            unused_variables,
            unreachable_patterns
        )]
    }
}

/// Has rustc agree that what is read of the system, or a constant, has the type that it was taken for, and
/// that methods of arrays are those of slices: other types have operators of their own, and traits methods.
pub fn are_plain(
    system: &System<'_>,
    of_type: [(Ident, Vec<TokenStream>); 2],
    of_arrays: &[(Ident, usize)],
) -> TokenStream {
    let System { name, scalar, .. } = system;
    let checks = of_type.into_iter().filter(|(_, tokens)| !tokens.is_empty()).map(|(ty, tokens)| {
        let count = Literal::usize_unsuffixed(tokens.len());
        // Errors are shown where the field is read.
        let references = tokens.iter().map(|tokens| {
            let span = span_of(tokens);
            quote_spanned!(span=> &(#tokens))
        });
        quote!(let _: [&dyn ::dalembert::generated::Plain<#ty>; #count] = [#(#references),*];)
    });
    let mut checks: Vec<_> = checks.collect();
    if !of_arrays.is_empty() {
        let count = Literal::usize_unsuffixed(of_arrays.len());
        let calls = of_arrays.iter().map(|(method, length)| {
            let length = Literal::usize_unsuffixed(*length);
            let zero = if scalar == "f32" { Literal::f32_suffixed(0.0) } else { Literal::f64_suffixed(0.0) };
            quote!([#zero; #length].#method())
        });
        checks.push(quote! {
            use ::dalembert::generated::SliceMethods as _;
            let _: [::dalembert::generated::OfSlice; #count] = [#(#calls),*];
        });
    }
    if checks.is_empty() {
        return TokenStream::new();
    }
    quote! {
        impl ::dalembert::generated::PlainFields for #name {
            fn plain_fields<Never>(&self) {
                #(#checks)*
            }
        }
    }
}

/// Has rustc agree that names taken for bindings are none of constants: a constant has another type.
pub fn are_bindings(names: &[Ident]) -> Option<TokenStream> {
    (!names.is_empty()).then(|| {
        quote! {
            const _: fn() = || {
                struct Binding;
                #(let #names = Binding;)*
            };
        }
    })
}
