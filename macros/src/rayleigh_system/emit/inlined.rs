//! Whether a function is worth inlining: the compiler keeps a copy of what is marked so for each part of a
//! program that calls it, and inlines none of them where they are long.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::quote;

/// Operations and calls of the longest function that is marked: twice those that the compiler inlines on its
/// own.
const LONGEST: usize = 100;

/// `#[inline]` for a function of this body, unless it is long.
pub fn inlined(body: &TokenStream) -> Option<TokenStream> {
    (operations(body) <= LONGEST).then(|| quote!(#[inline]))
}

fn operations(code: &TokenStream) -> usize {
    code.clone()
        .into_iter()
        .map(|token| match token {
            TokenTree::Punct(punct) => usize::from(matches!(punct.as_char(), '+' | '-' | '*' | '/')),
            TokenTree::Group(group) => {
                operations(&group.stream()) + usize::from(group.delimiter() == Delimiter::Parenthesis)
            }
            TokenTree::Ident(_) | TokenTree::Literal(_) => 0,
        })
        .sum()
}
