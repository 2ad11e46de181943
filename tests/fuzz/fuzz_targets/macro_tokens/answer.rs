//! What must hold of the macros' answer to any text.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

use super::pipeline::rayleigh_system::{Runtime, differentiable, rayleigh_system};

/// Groups within groups beyond this are not tried: syn's parser itself is recursive.
const DEEPEST: usize = 64;

/// Which macro an item is annotated with.
#[derive(Clone, Copy, PartialEq)]
enum Attribute {
    RayleighSystem,
    Differentiable,
}

/// Gives `text` to the macro that its first attribute names, as an attribute and an item, for each form of
/// the runtime.
///
/// Returns whether it was an item, which is all that rustc hands over.
///
/// # Panics
/// If the answer to an item is not a sequence of items, or says nothing of what is no item, or is another one
/// the second time.
pub fn check(text: &str) -> bool {
    let Ok(tokens) = text.parse::<TokenStream>() else { return false };
    if depth(&tokens) > DEEPEST {
        return false;
    }
    let (attribute, options, item) = parts(tokens);
    let is_item =
        syn::parse2::<syn::Item>(item.clone()).is_ok_and(|item| !matches!(item, syn::Item::Verbatim(_)));
    for runtime in [Runtime::STD, Runtime::PORTABLE, Runtime::CORE] {
        let expansion = || match attribute {
            Attribute::RayleighSystem => rayleigh_system(runtime, options.clone(), item.clone()),
            Attribute::Differentiable => differentiable(runtime, options.clone(), item.clone()),
        };
        let answer = expansion();
        if is_item {
            let items = syn::parse2::<syn::File>(answer.clone())
                .unwrap_or_else(|error| panic!("no items: {error}\n{answer}\nfor\n{text}"));
            assert!(!items.items.is_empty(), "nothing for\n{text}");
        } else {
            assert!(answer.to_string().contains("compile_error"), "not a word about\n{text}");
        }
        if runtime.has_std && !runtime.is_portable {
            assert_eq!(answer.to_string(), expansion().to_string(), "two answers to\n{text}");
        }
    }
    is_item
}

/// How deep groups are nested.
fn depth(tokens: &TokenStream) -> usize {
    let inner = |tree| if let TokenTree::Group(group) = tree { 1 + depth(&group.stream()) } else { 0 };
    tokens.clone().into_iter().map(inner).max().unwrap_or(0)
}

/// The macro, its options and the item, where the text begins with `#[rayleigh_system…]` or
/// `#[differentiable…]`; otherwise all of it is the item of a `#[rayleigh_system]`.
fn parts(tokens: TokenStream) -> (Attribute, TokenStream, TokenStream) {
    let mut rest = tokens.clone().into_iter();
    if let Some(TokenTree::Punct(hash)) = rest.next()
        && hash.as_char() == '#'
        && let Some(TokenTree::Group(group)) = rest.next()
        && group.delimiter() == Delimiter::Bracket
    {
        let mut inner = group.stream().into_iter();
        if let Some(TokenTree::Ident(name)) = inner.next() {
            let attribute = match name.to_string().as_str() {
                "rayleigh_system" => Some(Attribute::RayleighSystem),
                "differentiable" => Some(Attribute::Differentiable),
                _ => None,
            };
            let options = match inner.next() {
                Some(TokenTree::Group(options)) => options.stream(),
                _ => TokenStream::new(),
            };
            if let Some(attribute) = attribute {
                return (attribute, options, rest.collect());
            }
        }
    }
    (Attribute::RayleighSystem, TokenStream::new(), tokens)
}
