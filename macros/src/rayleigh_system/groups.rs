//! Groups without delimiters, in which `macro_rules` hands on the expressions that it has read.
//!
//! rustc forgets those that a procedural macro writes again: `$e * q` with `1.0 + 2.0` for `$e` would become
//! `1.0 + 2.0 * q`, in the user's own function too.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use syn::Expr;

use super::syntax::{is_assignment, regrouped};

/// The tokens, with parentheses around expressions of which what stands beside them could take a part.
pub fn in_parentheses(tokens: TokenStream) -> TokenStream {
    let visible = tokens.into_iter().map(|token| {
        let TokenTree::Group(group) = token else { return token };
        let inner = in_parentheses(group.stream());
        if group.delimiter() != Delimiter::None || !comes_apart(&inner) {
            return regrouped(&group, inner);
        }
        let mut parentheses = Group::new(Delimiter::Parenthesis, inner);
        parentheses.set_span(group.span());
        TokenTree::Group(parentheses)
    });
    visible.collect()
}

/// Whether the tokens are an expression of several parts that nothing holds together. Types and patterns
/// that read as one may stand in parentheses as well; an attribute `name = value` may not.
fn comes_apart(tokens: &TokenStream) -> bool {
    match syn::parse2(tokens.clone()) {
        Ok(Expr::Binary(binary)) => !is_assignment(&binary.op),
        Ok(
            Expr::Cast(_)
            | Expr::Closure(_)
            | Expr::If(_)
            | Expr::Match(_)
            | Expr::Range(_)
            | Expr::Reference(_)
            | Expr::Unary(_),
        ) => true,
        _ => false,
    }
}
