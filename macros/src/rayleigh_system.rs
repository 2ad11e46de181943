//! `#[rayleigh_system]`, from tokens to tokens.
//!
//! parse → check → lower → differentiate → emit, or, where a body cannot be lowered, parse → check → rewrite → expand.
//! Plain proc_macro2 code, so that tests and fuzzers can call it. Stages stop between each other: a stage that reported
//! anything is the last one, and the user's item is returned beside the diagnostics.

mod attribute;
mod check;
mod diagnostics;
mod differentiate;
mod emit;
mod expand;
mod expanded;
mod fallback;
mod graph;
mod lower;
mod model;
mod parse;
mod rewrite;
mod scope;

#[cfg(test)]
mod tests;

use proc_macro2::TokenStream;

use diagnostics::{Mistake, Report};
use model::Engine;

/// The expansion of `#[rayleigh_system(attribute)] item`.
pub fn rayleigh_system(attribute: TokenStream, item: TokenStream) -> TokenStream {
    let mut report = Report::default();
    let options = attribute::options(attribute, &mut report);
    let Some(source) = parse::source(item.clone(), &mut report) else {
        return fallback::item_alone(item, report);
    };
    let Some(system) = check::system(&source, options.rules, &mut report) else {
        return fallback::with_stubs(&source, report);
    };
    if options.engine != Engine::NumDual && report.is_empty() {
        let expansion = match lower::system(&system) {
            Ok(lowered) => expanded::system(&system, lowered).ok_or((None, Mistake::TooLong)),
            Err(refusal) => Err((Some(refusal.span), Mistake::NotLowered(refusal.reason))),
        };
        match expansion {
            Ok(expansion) => return expansion,
            Err((span, mistake)) if options.engine == Engine::Expanded => {
                report.at_span(span.unwrap_or_else(|| source.name().span()), mistake);
                return fallback::with_stubs(&source, report);
            }
            Err(_) => {}
        }
    }
    let system = rewrite::over_duals(system, &mut report);
    if report.is_empty() { expand::system(&system) } else { fallback::with_stubs(&source, report) }
}
