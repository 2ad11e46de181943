//! Functions over dual numbers that compute the expressions of the user's bodies: for bodies with enums,
//! options and other values that no dual number stands for. The user's item stands as written.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::Ident;

use super::super::derived::Kind;
use super::super::emit::{StraightLine, Writing};
use super::super::graph::Node;
use super::super::lower::Lowered;
use super::super::model::{Part, RayleighArguments, System};
use super::super::write::item::{are_bindings, quiet};

/// Whether the user's block has functions named as those over dual numbers.
pub fn names_are_taken(system: &System<'_>) -> bool {
    let generated = ["lagrangian_over", "rayleigh_over", "force_over", "time_scale_over"];
    system.source.functions().any(|function| generated.iter().any(|name| function.sig.ident == name))
}

/// L, R and f over `Real<D>`.
pub fn twins(system: &System<'_>, lowered: &Lowered) -> TokenStream {
    let name = &system.name;
    let both = RayleighArguments::ConfigurationAndVelocity;
    let of = |part, point, outputs: &[Node]| over(system, lowered, part, point, outputs);
    let lagrangian = of(Part::Lagrangian, both, &[lowered.lagrangian]);
    let rayleigh =
        system.rayleigh.zip(lowered.rayleigh).map(|(point, root)| of(Part::Rayleigh, point, &[root]));
    let force = lowered.force.as_ref().map(|components| of(Part::Force, both, components));
    let time_scale = lowered.time_scale.map(|root| time_scale(system, lowered, root));
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

/// σ over `Real<D>`.
fn time_scale(system: &System<'_>, lowered: &Lowered, root: Node) -> TokenStream {
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let line = over_duals(lowered, scalar, &[root]);
    let (statements, value) = (&line.statements, &line.outputs);
    quote! {
        /// `time_scale` over plain and dual numbers.
        #[inline(always)]
        fn time_scale_over<D: Dual<#scalar>>(&self, q: [Real<D>; #n]) -> Real<D> {
            #statements
            #(#value)*
        }
    }
}

fn over(
    system: &System<'_>,
    lowered: &Lowered,
    part: Part,
    point: RayleighArguments,
    outputs: &[Node],
) -> TokenStream {
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let line = over_duals(lowered, scalar, outputs);
    let q = (point == RayleighArguments::ConfigurationAndVelocity).then(|| quote!(q: [Real<D>; #n],));
    let input = system.input.as_ref().filter(|_| part == Part::Force).map(|input| input.times(1));
    let input = input.map(|m| quote!(u: [Real<D>; #m],));
    let time = system.timed.of(part).then(|| quote!(t: Real<D>,));
    let (function, statements, values) =
        (format_ident!("{}_over", part.name()), &line.statements, &line.outputs);
    let (result, value) = match part {
        Part::Force => (quote!([Real<D>; #n]), quote!([#(#values),*])),
        _ => (quote!(Real<D>), quote!(#(#values)*)),
    };
    let text = format!(" `{}` over plain and dual numbers.", part.name());
    quote! {
        #[doc = #text]
        #[inline(always)]
        fn #function<D: Dual<#scalar>>(&self, #q v: [Real<D>; #n], #input #time) -> #result {
            #statements
            #value
        }
    }
}
