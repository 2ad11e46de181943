//! The user's item, written again: its attributes and conditions, the struct of a function's parameters, and
//! what stands beside either engine's implementation.

use proc_macro2::{Delimiter, Literal, TokenStream, TokenTree};
use quote::{ToTokens, quote, quote_spanned};
use syn::{AttrStyle, Attribute, Ident};

use super::super::diagnostics::span_of;
use super::super::hygiene::unmarked;
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
    of_type: [(Ident, Vec<(TokenStream, bool)>); 2],
    of_arrays: &[(Ident, usize)],
) -> PlainFields {
    let System { name, scalar, .. } = system;
    // Errors are shown where the field is read.
    let reference = |tokens: &TokenStream| {
        let span = span_of(tokens);
        quote_spanned!(span=> &(#tokens))
    };
    let [(number, numbers), (truth, truths)] = of_type;
    let (mut numbers, mut others): (Vec<_>, Vec<_>) =
        numbers.into_iter().partition(|(tokens, is_free)| *is_free && is_place(tokens.clone()));
    others.extend(numbers.split_off(numbers.len().min(MOST_NAMED)));
    let [numbers, others, truths] =
        [numbers, others, truths].map(|of| of.into_iter().map(|(tokens, _)| tokens).collect::<Vec<_>>());
    let named = (!numbers.is_empty()).then(|| {
        let count = Literal::usize_unsuffixed(numbers.len());
        let fields = numbers.iter().map(|tokens| {
            let (name, reference) = (field_name(tokens), reference(tokens));
            quote!((#name, #reference))
        });
        quote! {
            #[cold]
            fn first_no_number(&self) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
                let fields: [(&'static str, &dyn ::dalembert::generated::Plain<#number>); #count] =
                    [#(#fields),*];
                ::dalembert::generated::missing::field(&fields)
            }
        }
    });
    let checks =
        [(number.clone(), others), (truth, truths)].into_iter().filter(|(_, tokens)| !tokens.is_empty());
    let checks = checks.map(|(ty, tokens)| {
        let count = Literal::usize_unsuffixed(tokens.len());
        let references = tokens.iter().map(reference);
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
    let checked = (!checks.is_empty()).then(|| {
        quote! {
            fn plain_fields<Never>(&self) {
                #(#checks)*
            }
        }
    });
    let names_fields = named.is_some();
    let implementation = (names_fields || checked.is_some()).then(|| {
        quote! {
            impl ::dalembert::generated::PlainFields for #name {
                #checked

                #named
            }
        }
    });
    PlainFields { implementation, names_fields }
}

/// The most numbers that are called by name where one is NaN: no program is to be long for what an error
/// asks for.
const MOST_NAMED: usize = 64;

/// The agreement with rustc on what is read of the system.
#[derive(Default)]
pub struct PlainFields {
    /// The `impl` that rustc checks.
    pub implementation: Option<TokenStream>,
    /// Whether it finds a number that is NaN.
    pub names_fields: bool,
}

/// Whether the tokens are a place, `self.c[0].1` or `Self::RATE`: reading it runs nothing of the user's.
fn is_place(tokens: TokenStream) -> bool {
    tokens.into_iter().all(|token| match token {
        TokenTree::Ident(_) | TokenTree::Literal(_) => true,
        TokenTree::Punct(punct) => matches!(punct.as_char(), '.' | ':'),
        TokenTree::Group(group) => {
            let mut index = group.stream().into_iter();
            group.delimiter() == Delimiter::Bracket
                && matches!((index.next(), index.next()), (Some(TokenTree::Literal(_)), None))
        }
    })
}

/// The name of a field or constant, as the body reads it: `k`, `c[0]`, `RATE`.
fn field_name(tokens: &TokenStream) -> String {
    let text = tokens.to_string().replace(' ', "");
    let own = text.strip_prefix("self.").or_else(|| text.strip_prefix("Self::"));
    unmarked(own.unwrap_or(&text))
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
