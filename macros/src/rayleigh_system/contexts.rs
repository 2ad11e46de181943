//! Locals of one name under different hygiene, told apart by their text.
//!
//! rustc tells a local of a `macro_rules` from one of its caller; the stages read names as text:
//!
//! ```text
//! let k = 2.0 * q[0]; $e * k    with $e = k + 1.0    →    let k·· = 2.0 * q[0]; (k + 1.0) * k··
//! ```
//!
//! Marks are taken off again where the expansion is done ([`hygiene`](super::hygiene)).

use std::collections::{BTreeMap, BTreeSet, HashMap};

use proc_macro2::{Ident, TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Item, PatIdent};

use super::hygiene::{MARK, is_member};
use super::syntax::regrouped;

/// The item, each local marked that another hygiene has a name of the same text beside.
pub fn apart(item: TokenStream) -> TokenStream {
    let mut contexts = BTreeMap::new();
    collect(item.clone(), &mut contexts);
    contexts.retain(|_, of| of.len() > 1);
    if contexts.is_empty() {
        return item;
    }
    // What is no item is told where items are parsed.
    let Ok(parsed) = syn::parse2(item.clone()) else { return item };
    let bound = bound(&parsed).into_iter().filter(|(name, _)| contexts.contains_key(name));
    // One mark is that of names that generated code has too.
    marked(item, &bound.zip(2..).collect())
}

/// The hygiene of a name, of which stable Rust shows no more than what `Debug` prints: `#3 bytes(10..11)`.
fn context(name: &Ident) -> String {
    let span = format!("{:?}", name.span());
    span.split(" bytes").next().filter(|context| context.starts_with('#')).unwrap_or_default().to_owned()
}

/// The contexts in which each name occurs.
fn collect(tokens: TokenStream, contexts: &mut BTreeMap<String, BTreeSet<String>>) {
    for token in tokens {
        match token {
            TokenTree::Ident(name) => {
                contexts.entry(name.to_string()).or_default().insert(context(&name));
            }
            TokenTree::Group(group) => collect(group.stream(), contexts),
            _ => {}
        }
    }
}

/// The locals of an item, each with its context.
fn bound(item: &Item) -> BTreeSet<(String, String)> {
    struct Bound(BTreeSet<(String, String)>);
    impl<'ast> Visit<'ast> for Bound {
        fn visit_pat_ident(&mut self, pattern: &'ast PatIdent) {
            self.0.insert((pattern.ident.to_string(), context(&pattern.ident)));
            visit::visit_pat_ident(self, pattern);
        }
    }
    let mut bound = Bound(BTreeSet::new());
    bound.visit_item(item);
    bound.0
}

/// The tokens, names that `marks` has marked so many times, but for members and what belongs to a path.
fn marked(tokens: TokenStream, marks: &HashMap<(String, String), usize>) -> TokenStream {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let marked = tokens.iter().enumerate().map(|(index, token)| match token {
        TokenTree::Ident(name) => match marks.get(&(name.to_string(), context(name))) {
            Some(&count) if !is_member(&tokens[..index]) => {
                TokenTree::Ident(Ident::new(&format!("{name}{}", MARK.repeat(count)), name.span()))
            }
            _ => token.clone(),
        },
        TokenTree::Group(group) => regrouped(group, marked(group.stream(), marks)),
        other => other.clone(),
    });
    marked.collect()
}
