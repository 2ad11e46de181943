//! Refusals: tokens that cannot be lowered, and why.

use proc_macro2::{Span, TokenStream};
use quote::ToTokens;

use super::super::diagnostics::span_of;

/// A token that cannot be lowered, and why.
#[derive(Debug)]
pub struct Refusal {
    pub span: Span,
    /// The tokens at `span`, on one line.
    pub token: String,
    pub reason: String,
    /// Whether dual numbers could not follow either.
    pub is_final: bool,
}

impl Refusal {
    pub fn at(tokens: &impl ToTokens, reason: impl Into<String>) -> Self {
        Self {
            span: span_of(tokens),
            token: one_line(&tokens.to_token_stream()),
            reason: reason.into(),
            is_final: false,
        }
    }

    /// Marks the refusal as final: dual numbers could not follow either.
    pub fn for_all(mut self) -> Self {
        self.is_final = true;
        self
    }

    /// The line of the source file, from 1; 0 where there is none.
    pub fn line(&self) -> usize {
        self.span.start().line
    }
}

/// The tokens as text, cut where they are long.
pub fn one_line(tokens: &TokenStream) -> String {
    const LONGEST: usize = 60;
    let text = tokens.to_string();
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} …", &line[..end]),
        None => line,
    }
}

pub type Result<T> = std::result::Result<T, Refusal>;

pub fn refuse<T>(tokens: &impl ToTokens, reason: impl Into<String>) -> Result<T> {
    Err(Refusal::at(tokens, reason))
}
