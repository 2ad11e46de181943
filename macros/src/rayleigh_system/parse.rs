//! From tokens to the annotated item.

use proc_macro2::TokenStream;
use syn::{Ident, Item, ItemFn, ItemImpl};

use super::diagnostics::{Mistake, Report};
use super::model::{Block, Function, Role, Source, simple_name};

/// Names that the generated code brings into its scope.
const RESERVED: &[&str] = &[
    "Real",
    "Dual",
    "Lagrangian",
    "Rayleigh",
    "Force",
    "Discrete",
    "DiscreteRayleigh",
    "DisplacementRule",
    "Midpoint",
    "Trapezoidal",
    "Fitted",
    "FittedTrapezoidal",
    "OneSided",
    "JointRule",
    "JointRayleighRule",
    "Gradient",
    "Derivatives",
    "CovectorDerivatives",
    "Variations",
    "Direction",
    "StepKernel",
    "Momenta",
    "DiscreteForce",
    "DiscreteForceDerivatives",
    "Driven",
    "DiscreteDriven",
    "MomentaBy",
    "Parameters",
    "DiscreteParameters",
    "GradientBy",
    "SecondOrder",
    "DiscreteSecondOrder",
    "Hessian",
    "SVector",
    "SMatrix",
    "Vector",
    "VectorField",
    "ScalarField",
    "ForcedLagrangian",
    "Stages",
    "Lanes",
    "LaneVector",
    "Mask",
    "D",
];

/// The annotated block or function, or nothing if it is neither.
pub fn source(item: TokenStream, report: &mut Report) -> Option<Source> {
    let source = match syn::parse2::<Item>(item) {
        Ok(Item::Impl(item)) => Source::Block(Box::new(block(item, report)?)),
        Ok(Item::Fn(item)) => Source::Function(Box::new(function(item, Role::System))),
        Ok(other) => {
            report.at(&other, Mistake::WrongItem);
            return None;
        }
        Err(error) => {
            report.error(error);
            return None;
        }
    };
    free_name(source, report)
}

/// The source, if the generated code does not use its name.
fn free_name(source: Source, report: &mut Report) -> Option<Source> {
    let name = source.name();
    if RESERVED.iter().any(|reserved| name == reserved) {
        report.at(name, Mistake::ReservedName(name.to_string()));
        return None;
    }
    Some(source)
}

fn block(item: ItemImpl, report: &mut Report) -> Option<Block> {
    if let Some((path, _)) = &item.trait_ {
        report.at(path, Mistake::TraitImpl);
        return None;
    }
    if !item.generics.params.is_empty() {
        report.at(&item.generics, Mistake::GenericBlock);
        return None;
    }
    let Some(name) = simple_name(&item.self_ty).cloned() else {
        report.at(&item.self_ty, Mistake::UnnamedType);
        return None;
    };
    Some(Block { item, name })
}

/// The function of a field, or nothing if the item is no function.
pub fn field(item: TokenStream, report: &mut Report) -> Option<Source> {
    let source = match syn::parse2::<Item>(item) {
        Ok(Item::Fn(item)) => Source::Function(Box::new(function(item, Role::Field))),
        Ok(other) => {
            report.at(&other, Mistake::WrongField);
            return None;
        }
        Err(error) => {
            report.error(error);
            return None;
        }
    };
    free_name(source, report)
}

fn function(item: ItemFn, role: Role) -> Function {
    let name = upper_camel_case(&item.sig.ident);
    Function { item, name, role }
}

/// `damped_oscillator` → `DampedOscillator`.
fn upper_camel_case(name: &Ident) -> Ident {
    let camel: String = name
        .to_string()
        .trim_start_matches("r#")
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
