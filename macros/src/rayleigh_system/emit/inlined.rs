//! Whether a function is worth inlining: the compiler keeps a copy of what is marked so for each part of a
//! program that calls it, and inlines none of them where they are long.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::quote;

use super::super::functions::is_elementary;

/// Operations and calls of the longest function that is marked: more than LLVM inlines where it is asked to.
const LONGEST: usize = 100;

/// `#[inline]` for a function of this body, unless it is long.
pub fn inlined(body: &TokenStream) -> Option<TokenStream> {
    (operations(body, 0) <= LONGEST).then(|| quote!(#[inline]))
}

/// [`inlined`] for a body on lanes, where one sine is long: it is written out for all of them.
pub fn inlined_on_lanes(body: &TokenStream) -> Option<TokenStream> {
    (operations(body, LONGEST) <= LONGEST).then(|| quote!(#[inline]))
}

/// Operations and calls, and so many more for each elementary function but those of a few instructions.
fn operations(code: &TokenStream, elementary: usize) -> usize {
    let is_long = |name: &str| is_elementary(name) && !["sqrt", "powi", "mul_add"].contains(&name);
    code.clone()
        .into_iter()
        .map(|token| match token {
            TokenTree::Punct(punct) => usize::from(matches!(punct.as_char(), '+' | '-' | '*' | '/')),
            TokenTree::Group(group) => {
                operations(&group.stream(), elementary)
                    + usize::from(group.delimiter() == Delimiter::Parenthesis)
            }
            TokenTree::Ident(name) if is_long(&name.to_string()) => elementary,
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
        assert_eq!(operations(&quote!(let a = (#short);), 0), 100);
        assert!(
            inlined(&quote!(let a = (#short);)).is_some() && inlined(&quote!(let a = (#long);)).is_none()
        );
        assert!(inlined_on_lanes(&short).is_some() && inlined_on_lanes(&quote!((#long))).is_none());
        let [root, sine] = [quote!(let a = (q[0].sqrt());), quote!(let a = (angles[0].sin_cos(q[0]));)];
        assert!(inlined_on_lanes(&root).is_some() && inlined_on_lanes(&sine).is_none());
        assert!(inlined(&sine).is_some());
    }
}
