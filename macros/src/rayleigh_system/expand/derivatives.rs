//! Derivatives by num-dual: each function evaluates a twin over dual numbers, twice named because of two kinds: those that
//! carry all derivatives, and those that carry the ones of a single pair of variables, for singular points.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::super::model::{RayleighArguments, System};

/// Gradient, derivatives and variations of L or R.
pub fn of_function(system: &System<'_>, function: &str, arguments: RayleighArguments) -> TokenStream {
    let System { scalar, .. } = system;
    let (n, twice) = (system.degrees.times(1), system.degrees.times(2));
    let [over, gradient, derivatives, variations] = ["_over", "_gradient", "_derivatives", "_variations"]
        .map(|suffix| format_ident!("{function}{suffix}"));
    let closure = match arguments {
        RayleighArguments::Velocity => quote!(|_, v| self.#over(v)),
        RayleighArguments::ConfigurationAndVelocity => quote!(|q, v| self.#over(q, v)),
    };
    // fn lagrangian_gradient(&self, q: …, v: …) -> Gradient<f64, 2> {
    //     dual::gradient(q, v, |q, v| self.lagrangian_over(q, v), |q, v| self.lagrangian_over(q, v))
    // }
    quote! {
        fn #gradient(&self, q: &Vector, v: &Vector) -> Gradient<#scalar, #n> {
            dual::gradient(q, v, #closure, #closure)
        }

        fn #derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<#scalar, #n> {
            dual::derivatives::<#scalar, #n, #twice>(q, v, #closure, #closure)
        }

        fn #variations(
            &self,
            q: &Vector,
            v: &Vector,
            minus: Direction<#scalar>,
            plus: Direction<#scalar>,
        ) -> Variations<#scalar, #n> {
            dual::variations(q, v, minus, plus, #closure, #closure)
        }
    }
}

/// Derivatives and variation of f.
pub fn of_force(system: &System<'_>) -> TokenStream {
    let System { scalar, .. } = system;
    let (n, twice) = (system.degrees.times(1), system.degrees.times(2));
    quote! {
        fn force_derivatives(&self, q: &Vector, v: &Vector) -> CovectorDerivatives<#scalar, #n> {
            dual::covector_derivatives::<#scalar, #n, #twice>(
                q,
                v,
                |q, v| self.force_over(q, v),
                |q, v| self.force_over(q, v),
            )
        }

        fn force_variation(
            &self,
            q: &Vector,
            v: &Vector,
            direction: Direction<#scalar>,
        ) -> (Vector, SMatrix<#scalar, #n, #n>) {
            dual::covector_variation(
                q,
                v,
                direction,
                |q, v| self.force_over(q, v),
                |q, v| self.force_over(q, v),
            )
        }
    }
}
