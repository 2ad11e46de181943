//! The name of the runtime in the user's crate: `::dalembert`, unless the attribute says `crate = …`.

use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use syn::Path;

use super::syntax::regrouped;

/// The tokens with the path in place of `::dalembert`.
pub fn runtime(tokens: TokenStream, path: &Path) -> TokenStream {
    let mut renamed: Vec<TokenTree> = Vec::new();
    for token in tokens {
        match token {
            TokenTree::Ident(word) if word == "dalembert" && ends_with_colons(&renamed) => {
                renamed.truncate(renamed.len() - 2);
                renamed.extend(path.to_token_stream());
            }
            TokenTree::Group(group) => renamed.push(regrouped(&group, runtime(group.stream(), path))),
            other => renamed.push(other),
        }
    }
    renamed.into_iter().collect()
}

/// Whether the path that follows starts at the crates: `::`, with no name before it.
fn ends_with_colons(tokens: &[TokenTree]) -> bool {
    let is_colon = |token: &TokenTree| matches!(token, TokenTree::Punct(punct) if punct.as_char() == ':');
    match tokens {
        [.., before, a, b] if is_colon(a) && is_colon(b) => {
            !matches!(before, TokenTree::Ident(word) if !is_keyword(&word.to_string()))
        }
        [a, b] => is_colon(a) && is_colon(b),
        _ => false,
    }
}

/// Words that a path may follow.
fn is_keyword(word: &str) -> bool {
    ["use", "as", "for", "impl", "mut", "dyn", "return", "in", "const"].contains(&word)
}
