//! `#[rayleigh_system]` and `#[differentiable]`, from tokens to tokens.
//!
//! options → parse → check → decide who makes the derivatives → write. Written out, they take lower →
//! differentiate → derived → emit; by dual numbers, rewrite. Plain proc_macro2 code, so that tests and
//! fuzzers can call it. Each stage goes on with what the one before it found sound, so that all mistakes
//! show in one compile; if there is any, the user's item is returned beside the diagnostics.

pub mod attribute;
pub mod check;
mod conditions;
mod constraints;
mod contexts;
mod decide;
mod depth;
pub mod derived;
pub mod diagnostics;
pub mod differentiate;
mod dual;
mod emit;
mod fallback;
mod functions;
pub mod graph;
mod groups;
pub mod hygiene;
mod joint;
mod kinks;
mod lanes;
pub mod lower;
mod model;
mod parameters;
pub mod parse;
mod parts;
mod portable;
mod renamed;
pub mod rules;
mod scope;
mod structure;
mod syntax;
mod valueless;
mod write;

use proc_macro2::TokenStream;

use decide::Decision;
use depth::Depth;
use diagnostics::{Mistake, Report};
use hygiene::Shared;
pub use model::Runtime;
use model::{Lanes, Source};
use rules::Rules;

/// The expansion of `#[rayleigh_system(attribute)] item`.
pub fn rayleigh_system(runtime: Runtime, attribute: TokenStream, item: TokenStream) -> TokenStream {
    on_own_stack(attribute, item, |attribute, item| expanded(runtime, attribute, item))
}

/// [`rayleigh_system`] where there is room for it.
fn expanded(runtime: Runtime, attribute: TokenStream, item: TokenStream) -> TokenStream {
    let mut report = Report::default();
    let item = contexts::apart(groups::in_parentheses(item));
    let names = Shared::of(&item);
    let options = attribute::options(names.marked_in(attribute), runtime, &mut report);
    let path = options.runtime.clone();
    let expansion = names.resolved(system(runtime, options, names.marked_in(item), report));
    match path {
        Some(path) => renamed::runtime(expansion, &path),
        None => expansion,
    }
}

/// Runs the stages where there is room for expressions as deep as those of the item.
fn on_own_stack(
    attribute: TokenStream,
    item: TokenStream,
    stages: impl FnOnce(TokenStream, TokenStream) -> TokenStream,
) -> TokenStream {
    let depths = [Depth::of(&attribute), Depth::of(&item)];
    if let Some(beyond) = depths.iter().find_map(Depth::beyond) {
        let mut report = Report::default();
        report.at_span(beyond, Mistake::TooDeep { most: depth::MOST_LEVELS });
        return fallback::item_alone(item, report);
    }
    let [attribute_depth, item_depth] = depths;
    item_depth.and(attribute_depth).on_own_stack(|| stages(attribute, item))
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
    let Some(system) = check::system(&source, &options, &mut report) else {
        return fallback::with_stubs(&source, &options.rules, &options.lanes, report);
    };
    if report.is_empty() && valueless::is_owed_in(&source, &system) {
        return fallback::with_stubs(&source, &options.rules, &options.lanes, report);
    }
    match decide::engine(&system, runtime, &mut report) {
        Decision::WrittenOut(derived) => write::expanded::system(&system, *derived, runtime.is_portable),
        Decision::DualNumbers(twins, why) => dual::system(&system, &twins, why, runtime.is_portable),
        Decision::Refused => fallback::with_stubs(&source, &options.rules, &options.lanes, report),
    }
}

/// The expansion of `#[differentiable] item`: the same stages, for a function of (q, parameters…).
pub fn differentiable(runtime: Runtime, attribute: TokenStream, item: TokenStream) -> TokenStream {
    on_own_stack(attribute, item, |attribute, item| expanded_field(runtime, attribute, item))
}

/// [`differentiable`] where there is room for it.
fn expanded_field(runtime: Runtime, attribute: TokenStream, item: TokenStream) -> TokenStream {
    let mut report = Report::default();
    let path = attribute::of_field(attribute, &mut report);
    let item = contexts::apart(groups::in_parentheses(item));
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
        return fallback::with_stubs(&source, &Rules::default(), &Lanes::default(), report);
    };
    if report.is_empty() && valueless::is_owed_in(&source, &system) {
        return fallback::with_stubs(&source, &Rules::default(), &Lanes::default(), report);
    }
    let twins = dual::rewrite::over_duals(&system, &mut report);
    if !runtime.has_std {
        report.at_span(source.name().span(), Mistake::FieldWithoutStd);
    }
    match &source {
        Source::Function(function) if report.is_empty() => {
            dual::field(&system, &twins[0], function, field, runtime.is_portable)
        }
        _ => fallback::with_stubs(&source, &Rules::default(), &Lanes::default(), report),
    }
}
