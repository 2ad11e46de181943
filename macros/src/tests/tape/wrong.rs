//! Texts with one name for two temporaries: the control.

use proc_macro2::{Group, Ident, TokenStream, TokenTree};
use quote::ToTokens;

use super::Written;

/// The function with a temporary named as one before it that is read later on.
pub fn with_one_name(written: &Written) -> Option<Written> {
    let statements = &written.function.block.stmts;
    let temporary = |statement: &syn::Stmt| match statement {
        syn::Stmt::Local(syn::Local { pat: syn::Pat::Ident(name), .. }) => Some(name.ident.clone()),
        _ => None,
    };
    let is_declared = |name: &Ident| {
        ["half", "t", "t_end", "q", "q1", "u", "p", "rate", "m", "k"].iter().any(|own| name == own)
    };
    let names = || statements.iter().enumerate().filter_map(|(i, of)| Some((i, temporary(of)?)));
    let (first, last) = names().filter(|(_, name)| !is_declared(name)).find_map(|(i, first)| {
        let is_read = |after: &[syn::Stmt]| after.iter().any(|of| mentions(of.to_token_stream(), &first));
        let mut later = names().filter(|(j, name)| *j > i && !is_declared(name));
        let last = later.find(|(j, _)| is_read(&statements[j + 1..]))?.1;
        Some((first.clone(), last))
    })?;
    let block = renamed(written.function.block.to_token_stream(), &last, &first);
    let block = syn::parse2(block).expect("a block");
    let function = syn::ImplItemFn { block, ..written.function.clone() };
    Some(Written { of: written.of.clone(), function })
}

fn mentions(tokens: TokenStream, word: &Ident) -> bool {
    tokens.into_iter().any(|token| match token {
        TokenTree::Ident(own) => own == *word,
        TokenTree::Group(group) => mentions(group.stream(), word),
        _ => false,
    })
}

fn renamed(tokens: TokenStream, from: &Ident, to: &Ident) -> TokenStream {
    let one = |token| match token {
        TokenTree::Ident(word) if word == *from => TokenTree::Ident(to.clone()),
        TokenTree::Group(group) => {
            TokenTree::Group(Group::new(group.delimiter(), renamed(group.stream(), from, to)))
        }
        other => other,
    };
    tokens.into_iter().map(one).collect()
}
