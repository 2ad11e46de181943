//! Functions over dual numbers that compute the expressions of the user's bodies: for bodies with enums,
//! options and other values that no dual number stands for. The user's item stands as written.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::Ident;

use super::super::derived::Kind;
use super::super::emit::{StraightLine, Writing};
use super::super::graph::Node;
use super::super::lower::Lowered;
use super::super::model::System;
use super::super::parts::{Part, Returns};
use super::super::write::item::{are_bindings, quiet};

/// Whether the user's block has functions named as those over dual numbers.
pub fn names_are_taken(system: &System<'_>) -> bool {
    let generated = Part::ALL.map(|part| format!("{}_over", part.name()));
    system.source.functions().any(|function| generated.iter().any(|name| function.sig.ident == name))
}

/// L, R and f over `Real<D>`.
pub fn twins(system: &System<'_>, lowered: &Lowered) -> TokenStream {
    let name = &system.name;
    let of = |part, outputs: &[Node]| over(system, lowered, part, outputs);
    let lagrangian = of(Part::Lagrangian, &[lowered.lagrangian]);
    let rayleigh = lowered.rayleigh.map(|root| of(Part::Rayleigh, &[root]));
    let force = lowered.force.as_ref().map(|components| of(Part::Force, components));
    let time_scale = lowered.time_scale.map(|root| of(Part::TimeScale, &[root]));
    let bindings = are_bindings(&lowered.bindings);
    let quiet_bindings =
        bindings.map(|bindings| quote!(#[allow(unused_variables, nonstandard_style)] #bindings));
    // fn lagrangian_over<D: Dual<f64>>(&self, q: [Real<D>; 2], v: [Real<D>; 2]) -> Real<D>
    let quiet = quiet();
    quote! {
        #quiet
        #[allow(dead_code)]
        impl #name {
            #lagrangian
            #rayleigh
            #force
            #time_scale
        }
        #quiet_bindings
    }
}

fn over_duals(lowered: &Lowered, scalar: &Ident, outputs: &[Node]) -> StraightLine {
    let taken = &["q", "v", "u", "t", "D"];
    Writing { graph: &lowered.graph, scalar, taken, is_portable: false }.written(outputs, &Kind::Duals)
}

/// A part over `Real<D>`.
fn over(system: &System<'_>, lowered: &Lowered, part: Part, outputs: &[Node]) -> TokenStream {
    let scalar = &system.scalar;
    let (n, m) = (system.degrees.times(1), system.inputs());
    let line = over_duals(lowered, scalar, outputs);
    let [q, v] = [quote!(q: [Real<D>; #n]), quote!(v: [Real<D>; #n])];
    let parameters = [q, v, quote!(u: [Real<D>; #m]), quote!(t: Real<D>)];
    let parameters = system.takes(part).unwrap_or_default().choose(parameters);
    let (function, statements, values) =
        (format_ident!("{}_over", part.name()), &line.statements, &line.outputs);
    let (result, value) = match part.entry().returns {
        Returns::Covector => (quote!([Real<D>; #n]), quote!([#(#values),*])),
        Returns::Number => (quote!(Real<D>), quote!(#(#values)*)),
        Returns::Numbers => {
            let count = values.len();
            (quote!([Real<D>; #count]), quote!([#(#values),*]))
        }
    };
    let text = format!(" `{}` over plain and dual numbers.", part.name());
    quote! {
        #[doc = #text]
        #[inline(always)]
        fn #function<D: Dual<#scalar>>(&self, #(#parameters),*) -> #result {
            #statements
            #value
        }
    }
}
