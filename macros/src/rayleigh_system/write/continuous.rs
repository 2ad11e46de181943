//! L, R, f and σ as functions: `Lagrangian`, `Rayleigh`, `Force`, `TimeScale` and `ForcedLagrangian`.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::super::model::{Home, System};
use super::super::parts::Part;
use super::super::structure::{Engine, Structure};
use super::constrained;
use super::friction::Friction;
use super::item::PlainFields;
use super::view::{self, owner, subject, value};

/// `impl Lagrangian<2> for Ring`, with the derivatives of either engine.
/// `places` are the functions of the system and of its view that find operations without a derivative.
pub fn lagrangian(
    system: &System<'_>,
    structure: &Structure,
    derivatives: TokenStream,
    places: &[Option<TokenStream>; 2],
    plain: &PlainFields,
    kinks: Option<&Friction>,
) -> TokenStream {
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let home = system.home_of(Part::Lagrangian);
    let subject = subject(system, home);
    let later = if home == Home::View { view::later(system) } else { None };
    let value = value(system, Part::Lagrangian);
    let asked = |home: Home| {
        let (verification, places) = (verification(system, home), &places[usize::from(home == Home::View)]);
        let is_expanded = matches!(structure.engine, Engine::Expanded);
        let missing = (!is_expanded || places.is_some()).then(|| without_derivative(system, structure, home));
        let non_finite = non_finite_value(system, home, plain.names_fields);
        let constraints = constrained::held(system, home);
        let massless = massless_force(system, home);
        let sliding = kinks.filter(|_| home == system.home()).map(|kinks| massless_velocity(system, kinks));
        quote!(#verification #missing #places #non_finite #massless #sliding #constraints)
    };
    let of_view = system.has_view().then(|| asked(Home::View));
    let asked = asked(home);
    let delegation = view::delegation(system, Part::Lagrangian, of_view);
    let (documentation, constant) = (structure.documentation(), structure.constant());
    quote! {
        #documentation
        #[automatically_derived]
        impl Lagrangian<#n> for #subject {
            type Scalar = #scalar;

            #constant

            #[inline]
            fn lagrangian(&self, q: &Vector, v: &Vector) -> #scalar {
                #value
            }

            #derivatives

            #asked

            #later
        }

        #delegation
    }
}

/// `fn without_derivative`: of L, R and f, as far as `home` has them.
fn without_derivative(system: &System<'_>, structure: &Structure, home: Home) -> TokenStream {
    let parts = system.terms().filter(|&part| home == Home::View || system.home_of(part) == home);
    // Where a rule takes kinks apart, a kink is no fault.
    let has_kinks = structure.findings.as_ref().is_some_and(|findings| findings.kinks > 0);
    let are_apart = has_kinks && system.rules.proximal.is_some() && home == system.home();
    let others = parts.skip(1).map(|part| match part {
        Part::Rayleigh if are_apart => format_ident!("dry_friction"),
        _ => format_ident!("{}", part.name()),
    });
    // missing::lagrangian(self, q, v).or_else(|| missing::rayleigh(self, q, v))
    quote! {
        #[cold]
        fn without_derivative(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::option::Option<::dalembert::generated::NoDerivative> {
            ::dalembert::generated::missing::lagrangian(self, q, v)
                #(.or_else(|| ::dalembert::generated::missing::#others(self, q, v)))*
        }
    }
}

/// `fn non_finite_value`: of the input and the time that a view holds, and of fields.
fn non_finite_value(system: &System<'_>, home: Home, names_fields: bool) -> Option<TokenStream> {
    let generated = quote!(::dalembert::generated);
    let is_view = home == Home::View;
    let input = (is_view && system.input.is_some()).then(|| quote!(#generated::missing::input(&self.u)));
    let time = (is_view && system.is_timed()).then(|| quote!(#generated::missing::time(self.t)));
    let owner = owner(home);
    let fields = names_fields.then(|| quote!(#generated::PlainFields::first_no_number(#owner)));
    let mut values = input.into_iter().chain(time).chain(fields);
    let (first, others) = (values.next()?, values);
    // missing::input(&self.u).or_else(|| PlainFields::first_no_number(self.system))
    Some(quote! {
        #[cold]
        fn non_finite_value(&self) -> ::core::option::Option<(#generated::Quantity, usize)> {
            #first #(.or_else(|| #others))*
        }
    })
}

/// `fn massless_force`: of R and f, where `home` has all that acts.
fn massless_force(system: &System<'_>, home: Home) -> Option<TokenStream> {
    let is_forced = system.has(Part::Rayleigh) || system.has(Part::Force);
    let (scalar, n) = (&system.scalar, system.degrees.times(1));
    let generated = quote!(::dalembert::generated);
    let value = if home == system.home() {
        quote!(::core::option::Option::Some(ActingForce::acting_force_derivatives(self, q, v)))
    } else {
        quote!(::core::option::Option::None)
    };
    is_forced.then(|| {
        quote! {
            #[cold]
            fn massless_force(
                &self,
                q: &Vector,
                v: &Vector,
            ) -> ::core::option::Option<#generated::CovectorDerivatives<#scalar, #n>> {
                #value
            }
        }
    })
}

/// `fn massless_velocity`: with the kinks of R.
fn massless_velocity(system: &System<'_>, kinks: &Friction) -> TokenStream {
    let (n, m) = (system.degrees.times(1), kinks.components());
    quote! {
        #[cold]
        fn massless_velocity(&self, q: &Vector, v: &Vector) -> ::core::option::Option<Vector> {
            ::dalembert::generated::massless_velocity::<Self, #n, #m>(self, q, v)
        }
    }
}

/// `fn verify_generated` and `fn verify_slopes`: of L, R and f, as far as `home` has them.
fn verification(system: &System<'_>, home: Home) -> TokenStream {
    let parts = system.terms().filter(|&part| home == Home::View || system.home_of(part) == home);
    let parts: Vec<_> = parts.map(Part::name).collect();
    let time_scale = (system.has(Part::TimeScale) && home == system.home())
        .then(|| quote!(::dalembert::generated::verification::time_scale(self, q)?;));
    let (n, m) = (system.degrees.times(1), system.constraint_count());
    let constraints = constrained::is_held(system, home)
        .then(|| quote!(::dalembert::generated::verification::constraints::<_, #n, #m>(self, q, v)?;));
    let before = quote!(#time_scale #constraints);
    // fn verify_generated(&self, q: …, v: …) -> Result<(), GeneratedDiffers> {
    //     verification::lagrangian(self, q, v)?; verification::rayleigh(self, q, v)
    // }
    let function = |name: &str, suffix: &str, before: Option<TokenStream>| {
        let name = format_ident!("{name}");
        let checks: Vec<_> = parts.iter().map(|part| format_ident!("{part}{suffix}")).collect();
        let (last, others) = checks.split_last()?;
        Some(quote! {
            fn #name(
                &self,
                q: &Vector,
                v: &Vector,
            ) -> ::core::result::Result<(), ::dalembert::generated::GeneratedDiffers> {
                #before
                #(::dalembert::generated::verification::#others(self, q, v)?;)*
                ::dalembert::generated::verification::#last(self, q, v)
            }
        })
    };
    let functions =
        [function("verify_generated", "", Some(before)), function("verify_slopes", "_slope", None)];
    quote!(#(#functions)*)
}

/// `impl Rayleigh<2> for Ring`, with the derivatives of either engine.
pub fn rayleigh(system: &System<'_>, derivatives: TokenStream) -> TokenStream {
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let subject = subject(system, system.home_of(Part::Rayleigh));
    let value = value(system, Part::Rayleigh);
    let delegation = view::delegation(system, Part::Rayleigh, None);
    let takes_q = system.takes(Part::Rayleigh).is_some_and(|takes| takes.q);
    let q = if takes_q { quote!(q) } else { quote!(_q) };
    quote! {
        #[automatically_derived]
        impl Rayleigh<#n> for #subject {
            #[inline]
            fn rayleigh(&self, #q: &Vector, v: &Vector) -> #scalar {
                #value
            }

            #derivatives
        }

        #delegation
    }
}

/// `impl Force<2> for Ring`, with the derivatives of either engine.
pub fn force(system: &System<'_>, derivatives: TokenStream) -> TokenStream {
    let n = system.degrees.times(1);
    let (subject, value) = (subject(system, system.home_of(Part::Force)), value(system, Part::Force));
    quote! {
        #[automatically_derived]
        impl Force<#n> for #subject {
            #[inline]
            fn force(&self, q: &Vector, v: &Vector) -> Vector {
                #value.into()
            }

            #derivatives
        }
    }
}

/// `impl TimeScale<2> for Ring`, with the gradient of either engine.
pub fn time_scale(system: &System<'_>, gradient: TokenStream) -> TokenStream {
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let (subject, value) = (subject(system, system.home()), value(system, Part::TimeScale));
    quote! {
        #[automatically_derived]
        impl ::dalembert::generated::TimeScale<#n> for #subject {
            fn time_scale(&self, q: &Vector) -> #scalar {
                #value
            }

            #gradient
        }
    }
}

/// `impl ActingForce<2> for Ring`: R and f, as far as the system has them, and terms that cancel.
pub fn acting_force(system: &System<'_>, cancelling_terms: Option<TokenStream>) -> TokenStream {
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let subject = subject(system, system.home());
    let rayleigh = system.has(Part::Rayleigh).then(|| {
        quote! {
            const HAS_RAYLEIGH: bool = true;

            #[inline]
            fn dissipation(&self, q: &Vector, v: &Vector) -> Gradient<#scalar, #n> {
                self.rayleigh_gradient(q, v)
            }

            #[inline]
            fn dissipation_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<#scalar, #n> {
                self.rayleigh_derivatives(q, v)
            }
        }
    });
    let force = system.has(Part::Force).then(|| {
        quote! {
            const HAS_FORCE: bool = true;

            #[inline]
            fn general_force(&self, q: &Vector, v: &Vector) -> Vector {
                Force::force(self, q, v)
            }

            #[inline]
            fn general_force_derivatives(
                &self,
                q: &Vector,
                v: &Vector,
            ) -> CovectorDerivatives<#scalar, #n> {
                self.force_derivatives(q, v)
            }
        }
    });
    let timed = system.is_timed().then(|| {
        quote!(
            const IS_TIMED: bool = true;
        )
    });
    quote! {
        #[automatically_derived]
        impl ActingForce<#n> for #subject {
            #rayleigh
            #force
            #timed
            #cancelling_terms
        }
    }
}

/// `impl ForcedLagrangian<2> for Ring`. The equations of motion at the stages are those that the runtime
/// makes of L and the acting force, unless an engine gives them.
pub fn forced_lagrangian(system: &System<'_>, stages: Option<TokenStream>) -> TokenStream {
    let n = system.degrees.times(1);
    let subject = subject(system, system.home());
    let stages = stages.unwrap_or_else(|| {
        quote!(
            type Anchors<const S: usize> = ();
        )
    });
    quote! {
        #[automatically_derived]
        impl ForcedLagrangian<#n> for #subject {
            #stages
        }
    }
}
