//! Whether a function is worth inlining: the compiler keeps a copy of what is marked so for each part of a
//! program that calls it, and inlines none of them where they are long.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::quote;

/// Operations and calls of the longest function that is marked: more than LLVM inlines where it is asked to.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Nested or not: 100 operations are marked, 101 are not.
    #[test]
    fn long_functions_are_not_marked() {
        let sums = |count: usize| -> TokenStream { vec![quote!(+ x); count].into_iter().collect() };
        let (short, long) = (sums(99), sums(100));
        assert_eq!(operations(&quote!(let a = (#short);)), 100);
        assert!(
            inlined(&quote!(let a = (#short);)).is_some() && inlined(&quote!(let a = (#long);)).is_none()
        );
    }
}
