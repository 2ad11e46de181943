//! `Discrete` by the rules that take L and R together.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::super::model::System;
use super::super::rules::{Joint, Rule};
use super::at_nodes;

/// `impl Discrete<Fitted, 2> for Ring`: L and R together, one call each.
pub fn discrete(
    system: &System<'_>,
    rule: Rule,
    joint: Joint,
    cancelling_terms: Option<TokenStream>,
) -> TokenStream {
    let System { name, scalar, .. } = system;
    let n = system.degrees.times(1);
    let (lagrangian, force) = (rule.entry().lagrangian, rule.entry().force);
    let linear = joint.is_linear.then(|| {
        quote!(
            const LINEAR: bool = true;
        )
    });
    let memory = format_ident!("{}", joint.memory);
    let memory = quote!(::dalembert::generated::#memory<#scalar, #n>);
    let rule = rule.ident();
    let nodes = at_nodes(system, &quote!(<#rule as JointRule>));
    quote! {
        #[automatically_derived]
        impl Discrete<#rule, #n> for #name {
            type Matrix = SMatrix<#scalar, #n, #n>;
            type Memory = #memory;
            #linear

            #[doc = #lagrangian]
            fn discrete_lagrangian(&self, q0: &Vector, q1: &Vector, h: #scalar) -> #scalar {
                <#rule as JointRule>::discrete_lagrangian(self, q0, q1, h)
            }

            /// L_d with D1, D2, D11, D12, D22.
            fn discrete_lagrangian_derivatives(
                &self,
                q0: &Vector,
                q1: &Vector,
                h: #scalar,
            ) -> Derivatives<#scalar, #n> {
                <#rule as JointRule>::discrete_lagrangian_derivatives(self, q0, q1, h)
            }

            #[doc = #force]
            fn discrete_force(&self, q0: &Vector, q1: &Vector, h: #scalar) -> DiscreteForce<#scalar, #n> {
                <#rule as JointRule>::discrete_force(self, q0, q1, h)
            }

            /// f_d with its derivatives by q0 and q1.
            fn discrete_force_derivatives(
                &self,
                q0: &Vector,
                q1: &Vector,
                h: #scalar,
            ) -> DiscreteForceDerivatives<#scalar, #n> {
                <#rule as JointRule>::discrete_force_derivatives(self, q0, q1, h)
            }

            /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄, at q1 = q0 + h v̄.
            #[inline]
            fn step_kernel(&self, q0: &Vector, v: &Vector, h: #scalar) -> StepKernel<#scalar, #n> {
                <#rule as JointRule>::step_kernel(self, q0, v, h)
            }

            /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺, at q1 = q0 + h v̄.
            #[inline]
            fn momenta(&self, q0: &Vector, v: &Vector, h: #scalar) -> Momenta<#scalar, #n> {
                <#rule as JointRule>::momenta(self, q0, v, h)
            }

            #cancelling_terms

            /// E_L on the segment.
            fn segment_energy(&self, q0: &Vector, q1: &Vector, h: #scalar) -> #scalar {
                <#rule as JointRule>::segment_energy(self, q0, q1, h)
            }

            #nodes
        }
    }
}
