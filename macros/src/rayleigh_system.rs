//! `#[rayleigh_system]` and `#[differentiable]`, from tokens to tokens.
//!
//! parse → check → rewrite → expand. Plain proc_macro2 code, so that tests and fuzzers can call it. Each stage goes on with
//! what the one before it found sound, so that all mistakes show in one compile; if there is any, the user's item is returned
//! beside the diagnostics.

mod attribute;
mod check;
mod diagnostics;
mod expand;
mod fallback;
mod implement;
mod model;
mod parse;
mod rewrite;
mod scope;
mod syntax;

use proc_macro2::TokenStream;

use diagnostics::{Mistake, Report};
use model::Source;

/// The expansion of `#[rayleigh_system(attribute)] item`.
pub fn rayleigh_system(attribute: TokenStream, item: TokenStream) -> TokenStream {
    let mut report = Report::default();
    let rules = attribute::rules(attribute, &mut report);
    let Some(source) = parse::source(item.clone(), &mut report) else {
        return fallback::item_alone(item, report);
    };
    let Some(system) = check::system(&source, rules, &mut report) else {
        return fallback::with_stubs(&source, report);
    };
    let system = rewrite::over_duals(system, &mut report);
    if report.is_empty() { expand::system(&system) } else { fallback::with_stubs(&source, report) }
}

/// The expansion of `#[differentiable] item`: the same stages, for a function of (q, parameters…).
pub fn differentiable(attribute: TokenStream, item: TokenStream) -> TokenStream {
    let mut report = Report::default();
    if !attribute.is_empty() {
        report.at(&attribute, Mistake::FieldOption);
    }
    let Some(source) = parse::field(item.clone(), &mut report) else {
        return fallback::item_alone(item, report);
    };
    let Some((system, field)) = check::field(&source, &mut report) else {
        return fallback::with_stubs(&source, report);
    };
    let system = rewrite::over_duals(system, &mut report);
    match &source {
        Source::Function(function) if report.is_empty() => expand::field(&system, function, field),
        _ => fallback::with_stubs(&source, report),
    }
}
