//! The names of the runtime that an implementation uses.

use quote::format_ident;
use syn::Ident;

use super::model::{Rule, System};

/// Traits and results, and no other: an unused import would warn in the user's crate.
pub fn imported(system: &System<'_>) -> Vec<Ident> {
    let mut names = vec!["Derivatives", "Direction", "Gradient", "Lagrangian", "Variations"];
    let rules = &system.rules;
    let is_forced = system.rayleigh.is_some() || system.has_force;
    if system.rayleigh.is_some() {
        names.push("Rayleigh");
    }
    if system.has_force {
        names.push("Force");
    }
    if system.has_force || (rules.gauss && is_forced) {
        names.push("CovectorDerivatives");
    }
    if rules.gauss {
        names.push("ForcedLagrangian");
    }
    if !rules.of_displacement.is_empty() {
        names.extend(["Discrete", "Momenta", "StepKernel"]);
        if rules.of_displacement.iter().any(|rule| !rule.is_joint()) {
            names.push("DisplacementRule");
        }
        if rules.of_displacement.iter().any(|rule| rule.is_joint()) {
            names.push("JointRule");
        }
        let with_rayleigh = |rule: &Rule| match rule {
            Rule::Fitted => system.degrees.literal() == Some(1),
            rule => rule.is_joint(),
        };
        if rules.of_displacement.iter().any(with_rayleigh) {
            names.push("JointRayleighRule");
        }
        if system.rayleigh.is_some() {
            names.push("DiscreteRayleigh");
        }
        if is_forced {
            names.extend(["DiscreteForce", "DiscreteForceDerivatives"]);
        }
    }
    // What the runtime gives of every forced Lagrangian, Gauss rules need no name for.
    let of_displacement = |name| (!rules.of_displacement.is_empty()).then_some(name);
    if system.input.is_some() {
        names.push("Driven");
        names.extend(of_displacement("DiscreteDriven"));
    }
    if !system.parameters.is_empty() {
        names.extend(["GradientBy", "Parameters"]);
        names.extend(of_displacement("DiscreteParameters"));
    }
    if system.input.is_some() || !system.parameters.is_empty() {
        names.extend(of_displacement("MomentaBy"));
    }
    if system.second {
        names.extend(["Hessian", "SecondOrder"]);
        names.extend(of_displacement("DiscreteSecondOrder"));
    }
    names.extend(rules.of_displacement.iter().map(|rule| rule.name()));
    names.sort_unstable();
    names.into_iter().map(|name| format_ident!("{name}")).collect()
}
