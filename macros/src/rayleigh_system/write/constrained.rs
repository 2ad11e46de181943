//! Constraints as functions: `Constrained`.

use proc_macro2::TokenStream;
use quote::quote;

use super::super::model::{Home, System};
use super::super::parts::Part;
use super::view::{subject, value};

/// `impl Constrained<2, 1> for Ring`, and for its view if it has one, with gradients and curvature written
/// out.
pub fn constrained(system: &System<'_>, functions: TokenStream) -> TokenStream {
    let scalar = &system.scalar;
    let (n, m) = (system.degrees.times(1), system.constraint_count());
    let (subject_of_system, value) = (subject(system, Home::System), value(system, Part::Constraints));
    let of_view = system.has_view().then(|| {
        let view = subject(system, Home::View);
        quote! {
            #[automatically_derived]
            impl ::dalembert::generated::Constrained<#n, #m> for #view {
                #[inline]
                fn constraints(&self, q: &Vector) -> SVector<#scalar, #m> {
                    ::dalembert::generated::Constrained::constraints(self.system, q)
                }

                #[inline]
                fn constraint_gradients(&self, q: &Vector) -> (SVector<#scalar, #m>, SMatrix<#scalar, #m, #n>) {
                    ::dalembert::generated::Constrained::constraint_gradients(self.system, q)
                }

                #[inline]
                fn constraint_curvature(
                    &self,
                    q: &Vector,
                    lambda: &SVector<#scalar, #m>,
                ) -> SMatrix<#scalar, #n, #n> {
                    ::dalembert::generated::Constrained::constraint_curvature(self.system, q, lambda)
                }
            }
        }
    });
    quote! {
        #[automatically_derived]
        impl ::dalembert::generated::Constrained<#n, #m> for #subject_of_system {
            #[inline]
            fn constraints(&self, q: &Vector) -> SVector<#scalar, #m> {
                #value.into()
            }

            #functions
        }

        #of_view
    }
}

/// `fn violation`, of a system with constraints and of its view, and that there are some.
pub fn violation(system: &System<'_>) -> Option<TokenStream> {
    system.constraints.as_ref()?;
    let (n, m) = (system.degrees.times(1), system.constraint_count());
    Some(quote! {
        const IS_CONSTRAINED: bool = true;

        #[cold]
        fn violation(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::option::Option<::dalembert::generated::Violation> {
            ::dalembert::generated::violation::<_, #n, #m>(self, q, v)
        }
    })
}
