//! Constraints as functions: `Constrained` and `ConstrainedParameters`.

use proc_macro2::TokenStream;
use quote::quote;

use super::super::model::{Home, System};
use super::super::parts::Part;
use super::view::{subject, value};

/// `impl Constrained<2, 1> for Ring`, and for its view if it has one, with the derivatives written out;
/// `is_prescribed` if the constraints move by themselves.
pub fn constrained(system: &System<'_>, functions: TokenStream, is_prescribed: bool) -> TokenStream {
    let (n, m) = (system.degrees.times(1), system.constraint_count());
    let home = system.home_of(Part::Constraints);
    let (subject_of_home, constants) = (subject(system, home), constants(system, is_prescribed));
    let values = values(system);
    let of_view = (home == Home::System && system.has_view()).then(|| delegation(system, &constants));
    quote! {
        #[automatically_derived]
        impl ::dalembert::generated::Constrained<#n, #m> for #subject_of_home {
            #constants

            #values

            #functions
        }

        #of_view
    }
}

/// `impl ConstrainedParameters<2, 1, 3> for Ring`.
pub fn by_parameters(system: &System<'_>, function: TokenStream) -> TokenStream {
    let (n, m, p) = (system.degrees.times(1), system.constraint_count(), system.parameter_count());
    let subject = subject(system, system.home());
    quote! {
        #[automatically_derived]
        impl ::dalembert::generated::ConstrainedParameters<#n, #m, #p> for #subject {
            #function
        }
    }
}

fn constants(system: &System<'_>, is_prescribed: bool) -> TokenStream {
    let of_velocity = system.constraints[1].as_ref().map(|count| {
        let count = count.times(1);
        quote!(
            const OF_VELOCITY: usize = #count;
        )
    });
    let prescribed = is_prescribed.then(|| {
        quote!(
            const IS_PRESCRIBED: bool = true;
        )
    });
    quote!(#of_velocity #prescribed)
}

/// The constraints as the user wrote them.
fn values(system: &System<'_>) -> TokenStream {
    let (scalar, m) = (&system.scalar, system.constraint_count());
    let [holonomic, of_velocity] =
        Part::CONSTRAINTS.map(|part| system.has(part).then(|| value(system, part)));
    let both = holonomic.is_some() && of_velocity.is_some();
    let holonomic = holonomic.map(|value| {
        let value =
            if both { quote!(::dalembert::generated::first_rows(#value)) } else { quote!(#value.into()) };
        quote! {
            #[inline]
            fn constraints(&self, q: &Vector) -> SVector<#scalar, #m> {
                #value
            }
        }
    });
    let of_velocity = of_velocity.map(|value| {
        let value =
            if both { quote!(::dalembert::generated::last_rows(#value)) } else { quote!(#value.into()) };
        quote! {
            #[inline]
            fn velocity_constraints(&self, q: &Vector, v: &Vector) -> SVector<#scalar, #m> {
                #value
            }
        }
    });
    quote!(#holonomic #of_velocity)
}

/// `impl Constrained<2, 1> for DrivenRing<'_>`, by the system.
fn delegation(system: &System<'_>, constants: &TokenStream) -> TokenStream {
    let (scalar, n, m) = (&system.scalar, system.degrees.times(1), system.constraint_count());
    let view = subject(system, Home::View);
    let of_system = quote!(::dalembert::generated::Constrained);
    let rows = quote!((SVector<#scalar, #m>, SMatrix<#scalar, #m, #n>));
    quote! {
        #[automatically_derived]
        impl #of_system<#n, #m> for #view {
            #constants

            #[inline]
            fn constraints(&self, q: &Vector) -> SVector<#scalar, #m> {
                #of_system::constraints(self.system, q)
            }

            #[inline]
            fn velocity_constraints(&self, q: &Vector, v: &Vector) -> SVector<#scalar, #m> {
                #of_system::velocity_constraints(self.system, q, v)
            }

            #[inline]
            fn constraint_gradients(&self, q: &Vector) -> #rows {
                #of_system::constraint_gradients(self.system, q)
            }

            #[cold]
            fn constraint_rounding(&self, q: &Vector) -> SVector<#scalar, #m> {
                #of_system::constraint_rounding(self.system, q)
            }

            #[inline]
            fn constraint_rates(&self, q: &Vector, v: &Vector) -> #rows {
                #of_system::constraint_rates(self.system, q, v)
            }

            #[inline]
            fn constraint_curvature(
                &self,
                q: &Vector,
                lambda: &SVector<#scalar, #m>,
            ) -> SMatrix<#scalar, #n, #n> {
                #of_system::constraint_curvature(self.system, q, lambda)
            }
        }
    }
}

/// Whether `home` has the constraints as functions.
pub fn is_held(system: &System<'_>, home: Home) -> bool {
    system.is_constrained() && (home == Home::View || system.home_of(Part::Constraints) == home)
}

/// That constraints hold the system, with `fn violation` and `fn normals` where `home` has them as functions.
pub fn held(system: &System<'_>, home: Home) -> Option<TokenStream> {
    if !system.is_constrained() {
        return None;
    }
    let (n, m) = (system.degrees.times(1), system.constraint_count());
    let is_nonholonomic = system.constraints[1].is_some().then(|| {
        quote!(
            const IS_NONHOLONOMIC: bool = true;
        )
    });
    let scalar = &system.scalar;
    let functions = is_held(system, home).then(|| {
        quote! {
            #[cold]
            fn violation(
                &self,
                q: &Vector,
                v: &Vector,
            ) -> ::core::option::Option<::dalembert::generated::Violation> {
                ::dalembert::generated::violation::<_, #n, #m>(self, q, v)
            }

            #[cold]
            fn normals(
                &self,
                q: &Vector,
            ) -> ::core::option::Option<::dalembert::generated::Normals<#scalar, #n>> {
                ::core::option::Option::Some(::dalembert::generated::normals::<_, #n, #m>(self, q))
            }
        }
    });
    Some(quote! {
        const IS_CONSTRAINED: bool = true;
        #is_nonholonomic

        #functions
    })
}
