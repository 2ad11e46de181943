//! Derivatives by num-dual: each function evaluates a twin over dual numbers.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::super::model::{Part, RayleighArguments, System};
use super::super::view::{arguments, owner};

/// Gradient, derivatives and variations of L or R.
pub fn of_function(system: &System<'_>, part: Part, point: RayleighArguments) -> TokenStream {
    let System { scalar, .. } = system;
    let (n, twice) = (system.degrees.times(1), system.degrees.times(2));
    let function = if part == Part::Lagrangian { "lagrangian" } else { "rayleigh" };
    let (owner, after) = (owner(system.home_of(part)), lifted(system, part));
    let [over, gradient, derivatives, variations] = ["_over", "_gradient", "_derivatives", "_variations"]
        .map(|suffix| format_ident!("{function}{suffix}"));
    let closure = match point {
        RayleighArguments::Velocity => quote!(|_, v| #owner.#over(v #(, #after)*)),
        RayleighArguments::ConfigurationAndVelocity => quote!(|q, v| #owner.#over(q, v #(, #after)*)),
    };
    // fn lagrangian_gradient(&self, q: …, v: …) -> Gradient<f64, 2> {
    //     dual::gradient(q, v, |q, v| self.lagrangian_over(q, v))
    // }
    quote! {
        fn #gradient(&self, q: &Vector, v: &Vector) -> Gradient<#scalar, #n> {
            dual::gradient(q, v, #closure)
        }

        fn #derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<#scalar, #n> {
            dual::derivatives::<#scalar, #n, #twice>(q, v, #closure)
        }

        fn #variations(
            &self,
            q: &Vector,
            v: &Vector,
            minus: Direction<#scalar>,
            plus: Direction<#scalar>,
        ) -> Variations<#scalar, #n> {
            dual::variations(q, v, minus, plus, #closure)
        }
    }
}

/// Derivatives and variation of f.
pub fn of_force(system: &System<'_>) -> TokenStream {
    let System { scalar, .. } = system;
    let (n, twice) = (system.degrees.times(1), system.degrees.times(2));
    let (owner, after) = (owner(system.home_of(Part::Force)), lifted(system, Part::Force));
    quote! {
        fn force_derivatives(&self, q: &Vector, v: &Vector) -> CovectorDerivatives<#scalar, #n> {
            dual::covector_derivatives::<#scalar, #n, #twice>(q, v, |q, v| #owner.force_over(q, v #(, #after)*))
        }

        fn force_variation(
            &self,
            q: &Vector,
            v: &Vector,
            direction: Direction<#scalar>,
        ) -> (Vector, SMatrix<#scalar, #n, #n>) {
            dual::covector_variation(q, v, direction, |q, v| #owner.force_over(q, v #(, #after)*))
        }
    }
}

/// The derivative of f by the input; empty where there is none.
pub fn by_input(system: &System<'_>) -> TokenStream {
    let Some(m) = system.input.as_ref().map(|input| input.times(1)) else { return TokenStream::new() };
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let time = system.timed.force.then(|| quote!(, dual::lift(self.t)));
    quote! {
        fn force_by_input(&self, q: &Vector, v: &Vector) -> SMatrix<#scalar, #n, #m> {
            dual::by_input(q, v, &self.u, |q, v, u| self.system.force_over(q, v, u #time))
        }
    }
}

/// What L, R or f takes after q and v, as constants of the dual numbers.
fn lifted(system: &System<'_>, part: Part) -> Vec<TokenStream> {
    arguments(system, part).into_iter().map(|argument| quote!(dual::lift(#argument))).collect()
}
