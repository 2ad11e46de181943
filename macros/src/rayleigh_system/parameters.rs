//! The fields that a step is differentiated by: whether the bodies read them.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::{ToTokens, quote};

use super::diagnostics::{Mistake, Report};
use super::graph::Operation;
use super::lower::Lowered;
use super::model::{Source, System};

/// Reports parameters that nothing reads, and those that are read where no derivative reaches them.
pub fn check(system: &System<'_>, lowered: &Lowered, report: &mut Report) {
    let graph = &lowered.graph;
    let others = lowered.force.iter().chain(&lowered.constraints).flatten().copied();
    let roots = [lowered.lagrangian].into_iter().chain(lowered.rayleigh).chain(others);
    let read: Vec<String> = graph
        .reachable(roots)
        .into_iter()
        .filter_map(|node| match graph.operation(node) {
            Operation::Parameter(index) => Some(graph.parameter(index).tokens.to_string()),
            _ => None,
        })
        .collect();
    for parameter in &system.parameters {
        let root = first_word(parameter.to_token_stream());
        let hides =
            |tokens: &&TokenStream| !is_entry((*tokens).clone()) && reads_field((*tokens).clone(), &root);
        if let Some(within) = graph.parameters().find(hides) {
            let (parameter_text, within) =
                (parameter.to_token_stream().to_string(), within.to_string().replace(" . ", "."));
            report.at(parameter, Mistake::HiddenParameter { parameter: parameter_text, within });
        } else if !read.contains(&quote!(self.#parameter).to_string()) {
            report.at(parameter, Mistake::NoSuchParameter(parameter.to_token_stream().to_string()));
        }
    }
}

/// Reports the parameters that nothing can read, where no expressions tell what is read: the item names no
/// such field.
pub fn check_unread(system: &System<'_>, report: &mut Report) {
    for parameter in &system.parameters {
        let root = first_word(parameter.to_token_stream());
        let is_read = match system.source {
            Source::Block(block) => reads_field(block.item.to_token_stream(), &root),
            Source::Function(function) => function.fields().any(|(field, _)| *field == root),
        };
        if !is_read {
            report.at(parameter, Mistake::NoSuchParameter(parameter.to_token_stream().to_string()));
        }
    }
}

fn first_word(tokens: TokenStream) -> String {
    tokens.into_iter().next().map(|word| word.to_string()).unwrap_or_default()
}

/// Whether the tokens are `self.c[0].1`: one entry, told by literals.
fn is_entry(tokens: TokenStream) -> bool {
    tokens.into_iter().all(|token| match token {
        TokenTree::Ident(_) | TokenTree::Literal(_) => true,
        TokenTree::Punct(punct) => punct.as_char() == '.',
        TokenTree::Group(group) => {
            let mut index = group.stream().into_iter();
            group.delimiter() == Delimiter::Bracket
                && matches!((index.next(), index.next()), (Some(TokenTree::Literal(_)), None))
        }
    })
}

/// Whether `self.field` stands anywhere among the tokens.
fn reads_field(tokens: TokenStream, field: &str) -> bool {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let here = tokens.windows(3).any(|three| match three {
        [TokenTree::Ident(owner), TokenTree::Punct(_), TokenTree::Ident(name)] => {
            owner == "self" && name == field
        }
        _ => false,
    });
    here || tokens.into_iter().any(|token| match token {
        TokenTree::Group(group) => reads_field(group.stream(), field),
        _ => false,
    })
}
