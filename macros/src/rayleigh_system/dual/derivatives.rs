//! Derivatives by num-dual: each function evaluates a twin over dual numbers, twice named because of two
//! kinds: those that carry all derivatives, and those that carry the ones of a single pair of variables, for
//! singular points.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::super::model::{Degrees, Home, System};
use super::super::parts::Part;
use super::super::write::view::owner;

/// `|q, v| self.lagrangian_over(q, v)`: a part over other numbers, on the type of this home.
fn closure(system: &System<'_>, home: Home, part: Part) -> TokenStream {
    let (over, owner) = (format_ident!("{}_over", part.name()), owner(home));
    let takes = system.takes(part).unwrap_or_default();
    let [q, v] = [(takes.q, quote!(q)), (takes.v, quote!(v))]
        .map(|(is_taken, name)| if is_taken { name } else { quote!(_) });
    let lifted = [quote!(q), quote!(v), quote!(dual::lift(self.u)), quote!(dual::lift(self.t))];
    let arguments = takes.choose(lifted);
    quote!(|#q, #v| #owner.#over(#(#arguments),*))
}

/// Gradient, derivatives and variations of L or R.
pub fn of_function(system: &System<'_>, part: Part) -> TokenStream {
    let System { scalar, .. } = system;
    let (n, twice) = (system.degrees.times(1), system.degrees.times(2));
    let function = part.name();
    let [gradient, derivatives, variations] =
        ["gradient", "derivatives", "variations"].map(|suffix| format_ident!("{function}_{suffix}"));
    let closure = closure(system, system.home_of(part), part);
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
    let closure = closure(system, system.home_of(Part::Force), Part::Force);
    quote! {
        fn force_derivatives(&self, q: &Vector, v: &Vector) -> CovectorDerivatives<#scalar, #n> {
            dual::covector_derivatives::<#scalar, #n, #twice>(
                q,
                v,
                #closure,
                #closure,
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
                #closure,
                #closure,
            )
        }
    }
}

/// `ActingForce::cancelling_terms`.
pub fn cancelling_terms(system: &System<'_>) -> TokenStream {
    let scalar = &system.scalar;
    let (n, twice) = (system.degrees.times(1), system.degrees.times(2));
    let closure = |part| closure(system, system.home(), part);
    let lagrangian = closure(Part::Lagrangian);
    let rayleigh = system.has(Part::Rayleigh).then(|| {
        let closure = closure(Part::Rayleigh);
        quote!(terms.rate += dual::terms_of_rayleigh::<#scalar, #n, #twice>(q, v, #closure);)
    });
    let force = system.has(Part::Force).then(|| {
        let closure = closure(Part::Force);
        quote!(terms.rate += dual::terms_of_force::<#scalar, #n, #twice>(q, v, #closure);)
    });
    let is_changed = rayleigh.is_some() || force.is_some();
    let mutable = is_changed.then(|| quote!(mut));
    quote! {
        /// Sizes of the terms that cancel in ∂L/∂v and in ∂L/∂q + f_L, at rest for instance.
        #[cold]
        fn cancelling_terms(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::dalembert::generated::CancellingTerms<#scalar, #n> {
            let #mutable terms = dual::terms_of_lagrangian::<#scalar, #n, #twice>(q, v, #lagrangian);
            #rayleigh
            #force
            terms
        }
    }
}

/// σ and ∇σ.
pub fn of_time_scale(system: &System<'_>) -> TokenStream {
    let scalar = &system.scalar;
    let closure = closure(system, system.home(), Part::TimeScale);
    quote! {
        fn time_scale_gradient(&self, q: &Vector) -> (#scalar, Vector) {
            let Gradient { value, d1, .. } = dual::gradient(q, q, #closure, #closure);
            (value, d1)
        }
    }
}

/// The derivative of f by the input.
pub fn by_input(system: &System<'_>, input: &Degrees) -> TokenStream {
    let scalar = &system.scalar;
    let (n, m) = (system.degrees.times(1), input.times(1));
    let time = system.takes_time(Part::Force).then(|| quote!(, dual::lift(self.t)));
    quote! {
        fn force_by_input(&self, q: &Vector, v: &Vector) -> SMatrix<#scalar, #n, #m> {
            dual::by_input(q, v, &self.u, |q, v, u| self.system.force_over(q, v, u #time))
        }
    }
}

/// The Hessians that second derivatives of the step need.
pub fn along_vectors(system: &System<'_>) -> TokenStream {
    let scalar = &system.scalar;
    let (n, m, twice) = (system.degrees.times(1), system.inputs(), system.degrees.times(2));
    let parts = system.terms().filter(|&part| part != Part::Force);
    let owner = owner(system.home());
    let functions = parts.map(|part| {
        let function = format_ident!("{}_along", part.name());
        // The trait stands on the view, wherever L and R do.
        let closure = closure(system, system.home(), part);
        quote! {
            fn #function(
                &self,
                q: &Vector,
                v: &Vector,
                a: &Vector,
                b: &Vector,
            ) -> Hessian<#scalar, #n, #m> {
                dual::hessian_along::<#scalar, #n, #m, #twice>(q, v, [a, b], #closure)
            }
        }
    });
    let force = system.has(Part::Force).then(|| {
        let time = system.takes_time(Part::Force).then(|| quote!(, dual::lift(self.t)));
        let (given, input) = match system.input {
            Some(_) => (quote!(&self.u), quote!(, u)),
            None => (quote!(&[]), quote!()),
        };
        let u = if system.input.is_some() { quote!(u) } else { quote!(_) };
        let total = match &system.input {
            Some(input) => {
                let total = |literals: (usize, usize)| Literal::usize_unsuffixed(2 * literals.0 + literals.1);
                match system.degrees.literal().zip(input.literal()).map(total) {
                    Some(total) => quote!(#total),
                    None => {
                        let m = input.times(1);
                        quote!({ (#twice) + (#m) })
                    }
                }
            }
            None => quote!(#twice),
        };
        quote! {
            fn force_along(&self, q: &Vector, v: &Vector, vector: &Vector) -> Hessian<#scalar, #n, #m> {
                dual::hessian_of_product::<#scalar, #n, #m, #total>(q, v, #given, vector, |q, v, #u| {
                    #owner.force_over(q, v #input #time)
                })
            }
        }
    });
    quote!(#(#functions)* #force)
}
