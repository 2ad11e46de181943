//! The system by num-dual: its functions over dual numbers, and derivatives that evaluate them when the
//! program runs.
//!
//! The comment above each quotation shows what it expands to.

mod derivatives;
mod expressions;
mod field;
mod notice;
pub mod rewrite;
mod twins;

use proc_macro2::TokenStream;
use quote::quote;

use super::lower::{Lowered, Refusal};
use super::model::{Source, System};
use super::parts::Part;
use super::structure::{Engine, Structure};
use super::write::item::{PlainFields, as_written, conditions};
use super::write::{self, EngineFunctions, view};
pub use expressions::names_are_taken;
pub use field::field;
use rewrite::Twin;

/// Where the functions over dual numbers come from.
pub enum Twins {
    /// The user's bodies, rewritten.
    Rewritten(Vec<Twin>),
    /// The expressions that the bodies compute, where rewriting them would need more than numbers.
    Lowered(Box<Lowered>),
}

/// The whole expansion: the user's item, its functions over dual numbers, and the system that they make.
///
/// `refusal`: why derivatives are not written out, where nobody asked for dual numbers.
pub fn system(
    system: &System<'_>,
    twins: &Twins,
    refusal: Option<Refusal>,
    is_portable: bool,
) -> TokenStream {
    let (functions, twins) = match (twins, system.source) {
        (Twins::Rewritten(twins), source) => (
            twins.iter().map(|twin| twin.plain.sig.ident.clone()).collect(),
            match source {
                Source::Block(_) => twins::twins_of_block(system, twins),
                Source::Function(function) => twins::twins_of_function(system, function, &twins[0]),
            },
        ),
        (Twins::Lowered(lowered), _) => (lowered.functions.clone(), expressions::twins(system, lowered)),
    };
    let item = as_written(system, &functions, is_portable);
    let warning = refusal.as_ref().map(|refusal| notice::warning(system, refusal));
    let bound = notice::bound(system);
    let (view, description) = (view::definition(system), view::description(system));
    let (conditions, quiet_twins) = (conditions(system.source), quiet_twins());
    let implementation = write::system(system, engine(system, refusal));
    // Bodies stand apart from the implementations: the fewer names are imported beside a user's code, the
    // fewer collide.
    quote! {
        #item

        #warning

        #bound

        #view

        #description

        #(#conditions)*
        #quiet_twins
        const _: () = {
            use ::dalembert::generated::dual::{self, Dual, Real};
            #twins
        };

        #implementation
    }
}

/// The functions that the runtime's traits ask for, by num-dual.
fn engine(system: &System<'_>, refusal: Option<Refusal>) -> EngineFunctions {
    EngineFunctions {
        structure: Structure { engine: Engine::NumDual(refusal), findings: None },
        lagrangian: derivatives::of_function(system, Part::Lagrangian),
        rayleigh: system.has(Part::Rayleigh).then(|| derivatives::of_function(system, Part::Rayleigh)),
        force: system.has(Part::Force).then(|| derivatives::of_force(system)),
        time_scale: system.has(Part::TimeScale).then(|| derivatives::of_time_scale(system)),
        constraints: None,
        constraints_by_parameters: None,
        friction: None,
        by_input: system.input.as_ref().map(|input| derivatives::by_input(system, input)),
        cancelling_terms: system
            .rules
            .ask_for_cancelling_terms()
            .then(|| derivatives::cancelling_terms(system)),
        places: [None, None],
        stages: None,
        kernels: system.rules.of_displacement.iter().map(|_| None).collect(),
        in_lanes: None,
        by_parameters: None,
        second_order: system.second.then(|| derivatives::along_vectors(system)),
        names: vec!["Direction", "Variations", "dual"],
        calls_elementary: false,
        bindings: Vec::new(),
        plain: PlainFields::default(),
    }
}

/// No lint speaks of the user's bodies a second time.
fn quiet_twins() -> TokenStream {
    quote! {
        #[allow(
            clippy::all,
            clippy::pedantic,
            clippy::nursery,
            deprecated,
            nonstandard_style,
            unreachable_code,
            unused
        )]
    }
}
