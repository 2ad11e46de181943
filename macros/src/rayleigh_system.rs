//! `#[rayleigh_system]` and `#[differentiable]`, from tokens to tokens.
//!
//! parse → check → lower → differentiate → emit, or, where a body cannot be lowered, parse → check → rewrite
//! → expand. Plain proc_macro2 code, so that tests and fuzzers can call it. Each stage goes on with what the
//! one before it found sound, so that all mistakes show in one compile; if there is any, the user's item is
//! returned beside the diagnostics.

pub mod attribute;
pub mod check;
mod conditions;
pub mod diagnostics;
pub mod differentiate;
mod dual_numbers;
mod emit;
mod expand;
mod expanded;
mod fallback;
pub mod graph;
pub mod hygiene;
mod implement;
mod imports;
mod item;
mod joint;
pub mod lower;
mod model;
pub mod parse;
mod portable;
mod renamed;
mod rewrite;
mod scope;
mod structure;
mod syntax;
mod view;

use proc_macro2::TokenStream;

use diagnostics::{Mistake, Report};
use expand::Twins;
use hygiene::Shared;
pub use model::Runtime;
use model::{Engine, Rules, Source};

/// The expansion of `#[rayleigh_system(attribute)] item`.
pub fn rayleigh_system(runtime: Runtime, attribute: TokenStream, item: TokenStream) -> TokenStream {
    let mut report = Report::default();
    let names = Shared::of(&item);
    let options = attribute::options(names.marked_in(attribute), runtime, &mut report);
    let path = options.runtime.clone();
    let expansion = names.resolved(system(runtime, options, names.marked_in(item), report));
    match path {
        Some(path) => renamed::runtime(expansion, &path),
        None => expansion,
    }
}

/// The expansion of a system whose options are read.
fn system(
    runtime: Runtime,
    options: attribute::Options,
    item: TokenStream,
    mut report: Report,
) -> TokenStream {
    let Some(source) = parse::source(item.clone(), &mut report) else {
        return fallback::item_alone(item, report);
    };
    conditions::refuse(&source, &mut report);
    let Some(mut system) = check::system(&source, options.rules.clone(), &mut report) else {
        return fallback::with_stubs(&source, &options.rules, report);
    };
    system.parameters = options.parameters;
    system.second = options.second;
    if !options.joint.is_empty() && report.is_empty() {
        let mut lowered = if options.engine == Engine::NumDual { None } else { lower::system(&system).ok() };
        for (name, rule) in &options.joint {
            if let Some(lacks) = joint::lacks(*rule, &system, options.engine, lowered.as_mut()) {
                report.at(name, Mistake::JointRule { rule: name.to_string(), lacks });
            }
        }
        if !report.is_empty() {
            return fallback::with_stubs(&source, &options.rules, report);
        }
    }
    // Parameters are differentiated by nothing else.
    let is_expanded = options.engine == Engine::Expanded || !system.parameters.is_empty();
    if is_expanded && report.is_empty() {
        let lowered = lower::system(&system);
        if let Ok(lowered) = &lowered {
            lower::parameters(&system, lowered, &mut report);
            if !report.is_empty() {
                return fallback::with_stubs(&source, &options.rules, report);
            }
        }
        let expansion = lowered.and_then(|lowered| expanded::system(&system, lowered, runtime.is_portable));
        return expansion.unwrap_or_else(|refusal| {
            // Advice that the system could not follow is none.
            let by_duals = !refusal.is_final && system.parameters.is_empty() && runtime.has_std && {
                let mut mistakes = Report::default();
                rewrite::over_duals(&system, &mut mistakes);
                mistakes.is_empty()
            };
            report.at_span(refusal.span, Mistake::NotLowered { reason: refusal.reason, by_duals });
            fallback::with_stubs(&source, &options.rules, report)
        });
    }
    let is_portable = runtime.is_portable;
    if options.engine == Engine::NumDual && report.is_empty() {
        let mut mistakes = Report::default();
        let twins = rewrite::over_duals(&system, &mut mistakes);
        let is_doubtful = twins.iter().any(|twin| twin.is_doubtful) && is_short(&system);
        if mistakes.is_empty() && !is_doubtful {
            return expand::system(&system, &Twins::Rewritten(&twins), None, is_portable);
        }
    }
    let refusal = match (report.is_empty().then(|| lower::system(&system)), options.engine) {
        // Derivatives may still be too long to be written out.
        (Some(Ok(lowered)), Engine::Auto) => match expanded::system(&system, lowered, is_portable) {
            Ok(expansion) => return expansion,
            Err(refusal) => Some(refusal),
        },
        (Some(Ok(lowered)), _) if !expand::lowered::names_are_taken(&system) => {
            return expand::system(&system, &Twins::Lowered(&lowered), None, is_portable);
        }
        (Some(Ok(_)), _) => None,
        (Some(Err(refusal)), _) if refusal.is_final => {
            report.at_span(refusal.span, Mistake::NotLowered { reason: refusal.reason, by_duals: false });
            return fallback::with_stubs(&source, &options.rules, report);
        }
        (Some(Err(refusal)), _) => Some(refusal),
        (None, _) => None,
    };
    let twins = rewrite::over_duals(&system, &mut report);
    if !report.is_empty() {
        // What stands elsewhere as it is, dual numbers cannot follow.
        if let Some(refusal) = refusal.filter(|_| report.is_limit_of_duals()) {
            report.at_span(refusal.span, Mistake::NeedsDuals(refusal.reason));
        }
        return fallback::with_stubs(&source, &options.rules, report);
    }
    match refusal {
        Some(refusal) if !runtime.has_std => {
            report.at_span(refusal.span, Mistake::NotLoweredWithoutStd(refusal.reason));
            fallback::with_stubs(&source, &options.rules, report)
        }
        refusal => {
            let refusal = refusal.filter(|_| options.engine == Engine::Auto);
            expand::system(&system, &Twins::Rewritten(&twins), refusal, is_portable)
        }
    }
}

/// Whether the expressions that the bodies compute are few enough to stand in for loops and calls.
fn is_short(system: &model::System<'_>) -> bool {
    const MOST_EXPRESSIONS: usize = 2_000;
    lower::system(system).is_ok_and(|lowered| lowered.graph.len() <= MOST_EXPRESSIONS)
}

/// The expansion of `#[differentiable] item`: the same stages, for a function of (q, parameters…).
pub fn differentiable(runtime: Runtime, attribute: TokenStream, item: TokenStream) -> TokenStream {
    let mut report = Report::default();
    let path = attribute::of_field(attribute, &mut report);
    let names = Shared::of(&item);
    let expansion = names.resolved(field(runtime, names.marked_in(item), report));
    match path {
        Some(path) => renamed::runtime(expansion, &path),
        None => expansion,
    }
}

/// The expansion of a field whose attribute is read.
fn field(runtime: Runtime, item: TokenStream, mut report: Report) -> TokenStream {
    let Some(source) = parse::field(item.clone(), &mut report) else {
        return fallback::item_alone(item, report);
    };
    conditions::refuse(&source, &mut report);
    let Some((system, field)) = check::field(&source, &mut report) else {
        return fallback::with_stubs(&source, &Rules::default(), report);
    };
    let twins = rewrite::over_duals(&system, &mut report);
    if !runtime.has_std {
        report.at_span(source.name().span(), Mistake::FieldWithoutStd);
    }
    match &source {
        Source::Function(function) if report.is_empty() => expand::field(&system, &twins[0], function, field),
        _ => fallback::with_stubs(&source, &Rules::default(), report),
    }
}
