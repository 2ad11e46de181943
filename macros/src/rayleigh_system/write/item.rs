//! The user's item, written again: its attributes and conditions, the struct of a function's parameters, and
//! what stands beside either engine's implementation.

use proc_macro2::TokenStream;
use quote::{ToTokens, quote};
use syn::{AttrStyle, Attribute, Ident};

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
    named(attributes, &["cfg"]).collect()
}

/// The lint levels that the user's item sets.
pub fn lint_levels(source: &Source) -> Vec<Attribute> {
    let attributes = match source {
        Source::Block(block) => &block.item.attrs,
        Source::Function(function) => &function.item.attrs,
    };
    named(attributes, &["allow", "warn", "deny", "forbid"]).collect()
}

/// Attributes that hold for a body wherever it stands.
pub fn lints(attributes: &[Attribute]) -> impl Iterator<Item = Attribute> {
    named(attributes, &["allow", "expect", "warn", "deny", "forbid", "cfg"])
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
