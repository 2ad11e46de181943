//! The names of the runtime that an implementation uses.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::Ident;

use super::super::model::{Home, System};
use super::super::parts::Part;

/// Imports the names that an implementation and its engine use, and no others: an unused import would warn in
/// the user's crate.
pub fn imports(system: &System<'_>, of_engine: &[&'static str], calls_elementary: bool) -> TokenStream {
    let mut names = of_traits(system);
    names.extend(of_engine);
    names.sort_unstable();
    names.dedup();
    let names: Vec<Ident> = names.into_iter().map(|name| format_ident!("{name}")).collect();
    let elementary = calls_elementary.then(|| {
        quote!(
            use ::dalembert::generated::Elementary as _;
        )
    });
    quote! {
        use ::dalembert::nalgebra::{SMatrix, SVector};
        use ::dalembert::generated::{#(#names),*};
        #elementary
    }
}

/// Traits and results.
fn of_traits(system: &System<'_>) -> Vec<&'static str> {
    let mut names = vec!["ActingForce", "Derivatives", "Gradient", "Lagrangian"];
    let rules = &system.rules;
    if rules.ask_for_variations() || delegates(system) {
        names.extend(["Direction", "Variations"]);
    }
    if system.has(Part::Rayleigh) {
        names.push("Rayleigh");
    }
    if system.has(Part::Force) {
        names.push("Force");
    }
    if system.has(Part::Force) {
        names.push("CovectorDerivatives");
    }
    if rules.gauss {
        names.push("ForcedLagrangian");
    }
    if !rules.of_displacement.is_empty() {
        names.extend(["Fused", "Momenta", "Segment", "StepKernel"]);
        if !rules.joint.is_empty() {
            names.push("JointRule");
        }
    }
    if system.input.is_some() {
        names.push("Driven");
    }
    if !system.parameters.is_empty() {
        names.extend(["GradientBy", "Parameters"]);
    }
    if system.second {
        names.extend(["Hessian", "SecondOrder"]);
    }
    names.extend(rules.of_displacement.iter().map(|rule| rule.entry().name));
    names
}

/// Whether L or R of the view is that of the system.
fn delegates(system: &System<'_>) -> bool {
    let is_own = |part: Part| part != Part::Force && system.home_of(part) == Home::System;
    system.has_view() && system.terms().any(is_own)
}
