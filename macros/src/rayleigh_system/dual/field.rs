//! A field on the configuration space, by num-dual: what `#[differentiable]` expands to.

use proc_macro2::TokenStream;
use quote::quote;

use super::super::check::Field;
use super::super::model::{Function, System};
use super::super::write::item::{as_written, conditions, quiet};
use super::quiet_twins;
use super::rewrite::Twin;
use super::twins::written;

/// The whole expansion of a field: the user's function, the struct of its parameters, and the field that it
/// is.
pub fn field(
    system: &System<'_>,
    twin: &Twin,
    function: &Function,
    kind: Field,
    is_portable: bool,
) -> TokenStream {
    let System { name, scalar, .. } = system;
    let n = system.degrees.times(1);
    let item = as_written(system, std::slice::from_ref(&function.item.sig.ident), is_portable);
    let conditions = conditions(system.source);
    let (quiet, quiet_twins) = (quiet(), quiet_twins());
    let twin_name = &twin.over.sig.ident;
    let told = twin.own_methods.told();
    let twin = written(twin, true);
    let lifted: Vec<_> = function.fields().map(|(field, _)| quote!(D::lift(self.#field))).collect();
    let result = match kind {
        Field::Vector => quote!([Real<D>; #n]),
        Field::Scalar => quote!(Real<D>),
    };
    let plain = &function.item.sig.ident;
    let fields = function.fields().map(|(field, _)| quote!(self.#field));
    let implementation = match kind {
        // impl VectorField<2> for Rotation
        Field::Vector => quote! {
            use ::dalembert::nalgebra::{SMatrix, SVector};
            use ::dalembert::generated::{VectorField, dual};

            type Vector = SVector<#scalar, #n>;

            #[automatically_derived]
            impl VectorField<#n> for #name {
                type Scalar = #scalar;

                fn vector(&self, q: &Vector) -> Vector {
                    #plain((*q).into(), #(#fields),*).into()
                }

                fn jacobian(&self, q: &Vector) -> SMatrix<#scalar, #n, #n> {
                    dual::jacobian(q, |q| self.field_over(q), |q| self.field_over(q))
                }
            }
        },
        // impl ScalarField<1> for Generating
        Field::Scalar => quote! {
            use ::dalembert::nalgebra::{SMatrix, SVector};
            use ::dalembert::generated::{ScalarField, dual};

            type Vector = SVector<#scalar, #n>;

            #[automatically_derived]
            impl ScalarField<#n> for #name {
                type Scalar = #scalar;

                fn value(&self, q: &Vector) -> #scalar {
                    #plain((*q).into(), #(#fields),*)
                }

                fn gradient(&self, q: &Vector) -> Vector {
                    dual::differential(q, |q| self.field_over(q), |q| self.field_over(q))
                }

                fn hessian(&self, q: &Vector) -> SMatrix<#scalar, #n, #n> {
                    dual::hessian(q, |q| self.field_over(q), |q| self.field_over(q))
                }
            }
        },
    };
    quote! {
        #item

        #(#conditions)*
        #quiet_twins
        const _: () = {
            use ::dalembert::generated::dual::{self, Dual, Real};

            #told

            #[allow(dead_code)]
            impl #name {
                #twin

                /// The field over plain and dual numbers.
                #[inline(always)]
                fn field_over<D: Dual<#scalar>>(&self, q: [Real<D>; #n]) -> #result {
                    Self::#twin_name(q, #(#lifted),*)
                }
            }
        };

        #(#conditions)*
        #quiet
        const _: () = {
            #implementation
        };
    }
}
