//! The traits of the runtime, implemented for a system with the functions that either engine makes: each
//! function below writes one `impl`, and the comment above each quotation shows what it expands to.

mod constrained;
mod continuous;
pub mod expanded;
mod friction;
mod fused;
mod imports;
mod in_lanes;
pub mod item;
pub mod notice;
mod on_request;
mod value_functions;
pub mod view;

use proc_macro2::TokenStream;
use quote::quote;
use syn::Ident;

use super::model::System;
use super::structure::{Engine, Structure};
pub use friction::Friction;
pub use fused::{Kernel, Memory};
pub use in_lanes::LaneFunctions;
use item::PlainFields;

/// The functions that the runtime's traits ask for, as an engine writes them.
pub struct EngineFunctions {
    /// The structure of the system.
    pub structure: Structure,
    /// Derivatives of L.
    pub lagrangian: TokenStream,
    /// Derivatives of R.
    pub rayleigh: Option<TokenStream>,
    /// Derivatives of f.
    pub force: Option<TokenStream>,
    /// σ and its gradient.
    pub time_scale: Option<TokenStream>,
    /// The derivatives of the constraints, and whether these move by themselves.
    pub constraints: Option<(TokenStream, bool)>,
    /// Derivatives of the constraints by the parameters.
    pub constraints_by_parameters: Option<TokenStream>,
    /// The kinks of R, where a rule takes them apart from the rest.
    pub friction: Option<Friction>,
    /// The derivative of f by the input.
    pub by_input: Option<TokenStream>,
    /// Sizes of the terms that cancel in the equations of motion, where some can.
    pub cancelling_terms: Option<TokenStream>,
    /// The operations without a derivative, where there can be some: of the system and of its view.
    pub places: [Option<TokenStream>; 2],
    /// The equations at the stages of Gauss rules, where they are not those that the runtime makes.
    pub stages: Option<TokenStream>,
    /// The kernel of each rule of displacement, where the engine writes one.
    pub kernels: Vec<Option<Kernel>>,
    /// The functions of several members at once, if they are asked for.
    pub in_lanes: Option<LaneFunctions>,
    /// Derivatives by parameters, if they are asked for.
    pub by_parameters: Option<TokenStream>,
    /// Second derivatives of the step, if they are asked for.
    pub second_order: Option<TokenStream>,
    /// Names of the runtime that the functions use.
    pub names: Vec<&'static str>,
    /// Whether they call the runtime's elementary functions.
    pub calls_elementary: bool,
    /// Names that rustc has to agree are bindings.
    pub bindings: Vec<Ident>,
    /// The numbers read of the system, for rustc to agree.
    pub plain: PlainFields,
}

/// The system: every trait that it implements, in a scope of their own.
pub fn system(system: &System<'_>, functions: EngineFunctions) -> TokenStream {
    let is_expanded = matches!(functions.structure.engine, Engine::Expanded);
    let is_explicit = functions.kernels.iter().flatten().any(|kernel| kernel.explicit.is_some());
    let may_cancel = functions.cancelling_terms.is_some();
    let mut names = functions.names;
    if fused::asks_rules(system, may_cancel, &functions.kernels) {
        names.push("DisplacementRule");
    }
    let imports = imports::imports(system, &names, functions.calls_elementary);
    let lagrangian = continuous::lagrangian(
        system,
        &functions.structure,
        functions.lagrangian,
        &functions.places,
        &functions.plain,
        functions.friction.as_ref(),
    );
    let rayleigh = functions.rayleigh.map(|derivatives| continuous::rayleigh(system, derivatives));
    let force = functions.force.map(|derivatives| continuous::force(system, derivatives));
    let time_scale = functions.time_scale.map(|function| continuous::time_scale(system, function));
    let constrained = functions
        .constraints
        .map(|(functions, is_prescribed)| constrained::constrained(system, functions, is_prescribed));
    let constrained_by_parameters =
        functions.constraints_by_parameters.map(|function| constrained::by_parameters(system, function));
    let value_functions = value_functions::value_functions(system);
    let acting = continuous::acting_force(system, functions.cancelling_terms);
    let forced = system.rules.gauss.then(|| continuous::forced_lagrangian(system, functions.stages));
    let driven = functions.by_input.and_then(|by_input| on_request::driven(system, by_input));
    let by_parameters = functions.by_parameters.map(|functions| on_request::by_parameters(system, functions));
    let friction = functions.friction.map(|kinks| friction::dry_friction(system, &kinks));
    let second_order = functions.second_order.map(|functions| on_request::second_order(system, functions));
    let rules = system.rules.of_displacement.iter().zip(functions.kernels);
    let fused = rules.map(|(&rule, kernel)| fused::fused(system, rule, (is_expanded, may_cancel), kernel));
    let in_lanes = functions.in_lanes.map(|functions| in_lanes::in_lanes(system, functions));
    let offered_methods = fused::offered_methods(system, is_explicit);
    let (bindings, plain) = (item::are_bindings(&functions.bindings), functions.plain.implementation);
    let (conditions, quiet) = (item::conditions(system.source), item::quiet());
    let (scalar, n) = (&system.scalar, system.degrees.times(1));
    quote! {
        #(#conditions)*
        #quiet
        const _: () = {
            #imports

            type Vector = SVector<#scalar, #n>;

            #plain

            #lagrangian
            #rayleigh
            #force
            #time_scale
            #constrained
            #constrained_by_parameters
            #value_functions
            #acting
            #forced
            #driven
            #by_parameters
            #second_order
            #friction
            #(#fused)*
            #in_lanes
            #offered_methods
            #bindings
        };
    }
}
