//! Names that both the user's item and the generated code have: no name is taken from a user.
//!
//! A user's name that generated code has too is marked before the item is read, and unmarked where the
//! expansion is done; whatever stands there unmarked is generated, and takes another name:
//!
//! ```text
//! struct Force { … }              use ::dalembert::generated::{Force as Force_, Lagrangian, …};
//! #[rayleigh_system]         →    impl Lagrangian<1> for Force { … }
//! impl Force { … }                impl Force_<1> for Force { … }
//! ```

use std::collections::HashSet;

use proc_macro2::{Ident, Literal, TokenStream, TokenTree};
use quote::quote;

use super::rules::Rule;
use super::syntax::regrouped;

/// The end of a marked name: nothing that says whether it is a type or a constant, and no name of Rust
/// code.
pub const MARK: &str = "__0__0__";

/// Names that generated code brings into its scope beside those of rules, the module `dual` among them.
pub const GENERATED: &[&str] = &[
    "ActingForce",
    "CovectorDerivatives",
    "Curve",
    "D",
    "Derivatives",
    "Direction",
    "DisplacementRule",
    "Driven",
    "Dual",
    "Force",
    "ForcedLagrangian",
    "Fused",
    "Gradient",
    "GradientBy",
    "Hessian",
    "JointRule",
    "Lagrangian",
    "LaneVector",
    "Lanes",
    "Mask",
    "MemberVector",
    "Members",
    "Momenta",
    "Never",
    "OwnMethods",
    "Parameters",
    "Rayleigh",
    "Real",
    "SMatrix",
    "SVector",
    "ScalarField",
    "SecondOrder",
    "Segment",
    "Stages",
    "StepKernel",
    "T",
    "Variations",
    "Vector",
    "VectorField",
    "dual",
];

/// The names of an item that generated code has too.
pub struct Shared {
    shared: HashSet<String>,
    /// All names of the item.
    all: HashSet<String>,
    /// Whether the item comes with marks.
    is_marked: bool,
}

impl Shared {
    /// Names of the annotated item, and of the struct that is named after its function.
    pub fn of(item: &TokenStream) -> Self {
        let mut all = HashSet::new();
        collect(item.clone(), &mut all);
        let tokens: Vec<TokenTree> = item.clone().into_iter().collect();
        all.extend(tokens.windows(2).filter_map(|pair| match pair {
            [TokenTree::Ident(keyword), TokenTree::Ident(name)] if keyword == "fn" => {
                Some(upper_camel_case(name).to_string())
            }
            _ => None,
        }));
        let shared = all.iter().filter(|name| is_generated(name)).cloned().collect();
        let is_marked = all.iter().any(|name| name.contains(MARK));
        Self { shared, all, is_marked }
    }

    /// The user's tokens, what is shared marked.
    pub fn marked_in(&self, tokens: TokenStream) -> TokenStream {
        if self.shared.is_empty() {
            return tokens;
        }
        let marked = tokens.into_iter().map(|token| match token {
            TokenTree::Ident(name) => TokenTree::Ident(marked(name)),
            TokenTree::Group(group) => regrouped(&group, self.marked_in(group.stream())),
            other => other,
        });
        marked.collect()
    }

    /// The expansion: shared names that are marked are the user's, others the generated code's.
    pub fn resolved(&self, tokens: TokenStream) -> TokenStream {
        let is_as_it_was = self.shared.is_empty() && !self.is_marked;
        if is_as_it_was { tokens } else { self.resolved_in(tokens, None) }
    }

    /// `module`: within an import, what the names come from.
    fn resolved_in(&self, tokens: TokenStream, mut module: Option<String>) -> TokenStream {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut resolved = TokenStream::new();
        for (index, token) in tokens.iter().enumerate() {
            let (before, after) = (&tokens[..index], tokens.get(index + 1));
            match token {
                TokenTree::Ident(name) => {
                    let text = name.to_string();
                    let is_leaf = !after.is_some_and(|next| is_punctuation(next, ':'));
                    if text == "use" {
                        module = Some(String::new());
                        resolved.extend([token.clone()]);
                    } else if text.contains(MARK) {
                        resolved.extend([Ident::new(&unmarked(&text), name.span())]);
                    } else if let Some(module) = &mut module {
                        let leaf = if text == "self" { module.clone() } else { text.clone() };
                        if is_leaf && self.shared.contains(&leaf) {
                            let renamed = self.renamed(&leaf, name);
                            resolved.extend(quote!(#name as #renamed));
                        } else {
                            resolved.extend([token.clone()]);
                        }
                        *module = text;
                    } else if self.shared.contains(&text) && !is_member(before) {
                        resolved.extend([self.renamed(&text, name)]);
                    } else {
                        resolved.extend([token.clone()]);
                    }
                }
                TokenTree::Group(group) => {
                    resolved.extend([regrouped(group, self.resolved_in(group.stream(), module.clone()))]);
                }
                TokenTree::Literal(literal) => resolved.extend([unmarked_literal(literal)]),
                TokenTree::Punct(punct) => {
                    if punct.as_char() == ';' {
                        module = None;
                    }
                    resolved.extend([token.clone()]);
                }
            }
        }
        resolved
    }

    /// `Force_`, or with more underscores where the user has that too.
    fn renamed(&self, text: &str, name: &Ident) -> Ident {
        let mut renamed = format!("{text}_");
        while self.all.contains(&renamed) {
            renamed.push('_');
        }
        Ident::new(&renamed, name.span())
    }
}

/// The name of the user's, marked if generated code has it too.
pub fn marked(name: Ident) -> Ident {
    if is_generated(&name.to_string()) { Ident::new(&format!("{name}{MARK}"), name.span()) } else { name }
}

/// The text with the user's names as the user wrote them.
pub fn unmarked(text: &str) -> String {
    text.replace(MARK, "")
}

fn is_generated(name: &str) -> bool {
    GENERATED.contains(&name) || Rule::ALL.iter().any(|rule| rule.entry().name == name)
}

fn collect(tokens: TokenStream, names: &mut HashSet<String>) {
    for token in tokens {
        match token {
            TokenTree::Ident(name) => {
                names.insert(name.to_string());
            }
            TokenTree::Group(group) => collect(group.stream(), names),
            _ => {}
        }
    }
}

/// Whether what follows belongs to a path or a value: `::dalembert::`, `self.`; what ends a range does not.
pub fn is_member(before: &[TokenTree]) -> bool {
    match before {
        [.., a, b] if is_punctuation(a, ':') && is_punctuation(b, ':') => true,
        [.., a, b] if is_punctuation(a, '.') && is_punctuation(b, '.') => false,
        [.., dot] => is_punctuation(dot, '.'),
        [] => false,
    }
}

fn is_punctuation(token: &TokenTree, mark: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == mark)
}

/// Messages and documentation name what the user wrote.
fn unmarked_literal(literal: &Literal) -> TokenTree {
    let text = literal.to_string();
    let own = text.contains(MARK).then(|| unmarked(&text).parse::<Literal>().ok()).flatten();
    let mut own = own.unwrap_or_else(|| literal.clone());
    own.set_span(literal.span());
    TokenTree::Literal(own)
}

/// `damped_oscillator` → `DampedOscillator`.
pub fn upper_camel_case(name: &Ident) -> Ident {
    let camel: String = name
        .to_string()
        .trim_start_matches("r#")
        .trim_end_matches(MARK)
        .split('_')
        .filter_map(|word| {
            let mut letters = word.chars();
            letters.next().map(|first| first.to_uppercase().chain(letters).collect::<String>())
        })
        .collect();
    // A name without a leading letter makes no type name.
    let camel = if camel.starts_with(char::is_alphabetic) { camel } else { format!("System{camel}") };
    Ident::new(&camel, name.span())
}
