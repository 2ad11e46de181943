//! A system discretised by a rule: `Discrete`, `DiscreteRayleigh`, and the methods that an error can be asked
//! of.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::super::emit::inlined;
use super::super::model::System;
use super::super::rules::Rule;
use super::at_nodes;
use super::joint;
use super::view::subject;

/// The step's equation as an engine makes it: bodies of the functions that a step calls, L, R and f
/// together, and what its structure allows.
pub struct Kernel {
    pub step_kernel: TokenStream,
    pub momenta: TokenStream,
    /// The diagonals of a banded Newton matrix.
    pub diagonals: Option<usize>,
    /// The step is one linear solve.
    pub is_linear: bool,
    pub memory: Memory,
    /// The functions of an explicit step.
    pub explicit: Option<TokenStream>,
    /// The functions of an explicit step of several members at once.
    pub explicit_in_lanes: Option<TokenStream>,
    /// The equation of several members at once.
    pub in_lanes: Option<TokenStream>,
}

/// The memory of a run.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Memory {
    Velocities,
    Matrix,
    Explicit,
}

/// `impl Discrete<Midpoint, 2> for Ring`: one term for each of L, R and f that the system has, unless an
/// engine gives the kernel's bodies. `may_cancel`: whether terms of the equations of motion can.
pub fn discrete(
    system: &System<'_>,
    rule: Rule,
    (is_expanded, may_cancel): (bool, bool),
    kernel: Option<Kernel>,
) -> TokenStream {
    let cancelling_terms =
        (may_cancel && rule.asks_for_cancelling_terms()).then(|| cancelling_terms(system, rule));
    if let Some(shared) = rule.joint() {
        return joint::discrete(system, rule, shared, cancelling_terms);
    }
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let subject = subject(system, system.home());
    let lagrangian = rule.entry().lagrangian;
    let force = rule.force(system.rayleigh.is_some(), system.has_force);
    let rule = rule.ident();
    let terms = |of_rayleigh: &str, of_force: &str| {
        let of_rayleigh = system.rayleigh.map(|_| format_ident!("{of_rayleigh}"));
        let of_force = system.has_force.then(|| format_ident!("{of_force}"));
        of_rayleigh.into_iter().chain(of_force)
    };
    let kernels = terms("rayleigh_kernel", "force_kernel");
    let momenta = terms("rayleigh_momenta", "force_momenta");
    let forces: Vec<_> = terms("rayleigh_force", "general_force").collect();
    let force_derivatives = terms("rayleigh_force_derivatives", "general_force_derivatives");
    // f_d⁻, f_d⁺: Midpoint::rayleigh_force(self, q0, q1, h)
    let discrete_force = (!forces.is_empty()).then(|| {
        quote! {
            #[doc = #force]
            fn discrete_force(&self, q0: &Vector, q1: &Vector, h: #scalar) -> DiscreteForce<#scalar, #n> {
                #(#rule::#forces(self, q0, q1, h))+*
            }

            /// f_d with its derivatives by q0 and q1.
            fn discrete_force_derivatives(
                &self,
                q0: &Vector,
                q1: &Vector,
                h: #scalar,
            ) -> DiscreteForceDerivatives<#scalar, #n> {
                #(#rule::#force_derivatives(self, q0, q1, h))+*
            }
        }
    });
    let Kernel {
        step_kernel,
        momenta,
        diagonals,
        is_linear,
        memory,
        explicit,
        explicit_in_lanes,
        in_lanes,
    } = kernel.unwrap_or_else(|| Kernel {
        step_kernel: quote!(#rule::lagrangian_kernel(self, q0, v, h) #(+ #rule::#kernels(self, q0, v, h))*),
        momenta: quote!(#rule::lagrangian_momenta(self, q0, v, h) #(+ #rule::#momenta(self, q0, v, h))*),
        diagonals: None,
        is_linear: false,
        memory: Memory::Velocities,
        explicit: None,
        explicit_in_lanes: None,
        in_lanes: None,
    });
    let [inline_kernel, inline_momenta] = [&step_kernel, &momenta].map(inlined);
    let (matrix, kernel) = match diagonals {
        None => (quote!(SMatrix<#scalar, #n, #n>), quote!(StepKernel<#scalar, #n>)),
        Some(diagonals) => {
            let diagonals = Literal::usize_unsuffixed(diagonals);
            (
                quote!(::dalembert::generated::Banded<#scalar, #n, #diagonals>),
                quote!(StepKernel<#scalar, #n, Self::Matrix>),
            )
        }
    };
    let memory = match memory {
        Memory::Velocities => quote!(::dalembert::generated::VelocityHistory<#scalar, #n>),
        Memory::Matrix => quote!(::dalembert::generated::KeptMatrix<#scalar, Self::Matrix, #n>),
        Memory::Explicit => quote!(::dalembert::generated::ExplicitMemory<#scalar, Self::Matrix, #n>),
    };
    let linear = is_linear.then(|| {
        quote!(
            const LINEAR: bool = true;
        )
    });
    // impl Explicit<2> for Ring
    let explicit = explicit.map(|functions| {
        quote! {
            #[automatically_derived]
            impl ::dalembert::generated::Explicit<#n> for #subject {
                #functions
            }
        }
    });
    // impl ExplicitInLanes<2> for Ring
    let explicit_in_lanes = explicit_in_lanes.map(|functions| {
        quote! {
            #[automatically_derived]
            impl ::dalembert::generated::ExplicitInLanes<#n> for #subject {
                #functions
            }
        }
    });
    // impl DiscreteInLanes<Midpoint, 2> for Ring
    let in_lanes = in_lanes.map(|functions| {
        quote! {
            #[automatically_derived]
            impl ::dalembert::generated::DiscreteInLanes<#rule, #n> for #subject {
                #functions
            }
        }
    });
    let nodes = at_nodes(system, &quote!(#rule));
    let written_out = is_expanded.then(|| {
        quote!(
            const WRITTEN_OUT: bool = true;
        )
    });
    // p0 = −D1 L_d − f_d⁻: Midpoint::lagrangian_kernel(self, q0, v, h) + Midpoint::rayleigh_kernel(self, q0,
    // v, h)
    quote! {
        #[automatically_derived]
        impl Discrete<#rule, #n> for #subject {
            type Matrix = #matrix;
            type Memory = #memory;
            #linear
            #written_out

            #[doc = #lagrangian]
            fn discrete_lagrangian(&self, q0: &Vector, q1: &Vector, h: #scalar) -> #scalar {
                #rule::discrete_lagrangian(self, q0, q1, h)
            }

            /// L_d with D1, D2, D11, D12, D22.
            fn discrete_lagrangian_derivatives(
                &self,
                q0: &Vector,
                q1: &Vector,
                h: #scalar,
            ) -> Derivatives<#scalar, #n> {
                #rule::discrete_lagrangian_derivatives(self, q0, q1, h)
            }

            #discrete_force

            /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄, at q1 = q0 + h v̄.
            #inline_kernel
            fn step_kernel(&self, q0: &Vector, v: &Vector, h: #scalar) -> #kernel {
                #step_kernel
            }

            /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺, at q1 = q0 + h v̄.
            #inline_momenta
            fn momenta(&self, q0: &Vector, v: &Vector, h: #scalar) -> Momenta<#scalar, #n> {
                #momenta
            }

            #cancelling_terms

            /// E_L on the segment.
            fn segment_energy(&self, q0: &Vector, q1: &Vector, h: #scalar) -> #scalar {
                #rule::segment_energy(self, q0, q1, h)
            }

            #nodes
        }

        #in_lanes

        #explicit

        #explicit_in_lanes
    }
}

/// `fn cancelling_terms`, by the rule.
fn cancelling_terms(system: &System<'_>, rule: Rule) -> TokenStream {
    let (scalar, name) = (&system.scalar, rule.ident());
    let functions = rule.joint().map_or_else(|| quote!(#name), |_| quote!(<#name as JointRule>));
    quote! {
        /// Sizes of the terms that cancel in p0, at rest for instance.
        #[cold]
        fn cancelling_terms(&self, q0: &Vector, v: &Vector, h: #scalar) -> Vector {
            #functions::cancelling_terms(self, q0, v, h)
        }
    }
}

/// `impl OffersMethods<2> for Ring`: what an error can be asked of.
pub fn offered_methods(system: &System<'_>, is_explicit: bool) -> Option<TokenStream> {
    let mut rules = system.rules.of_displacement.iter();
    let rule =
        rules.find(|rule| if is_explicit { rule.may_be_explicit() } else { rule.entry().is_self_adjoint });
    let rule = rule?.ident();
    let mut methods = quote!(#rule);
    if is_explicit {
        methods = quote!(::dalembert::generated::WithSplittings<#methods>);
    }
    if system.rules.gauss {
        methods = quote!(::dalembert::generated::WithGauss<#methods>);
    }
    let n = system.degrees.times(1);
    let subject = subject(system, system.home());
    Some(quote! {
        #[automatically_derived]
        impl ::dalembert::generated::OffersMethods<#n> for #subject {
            type Methods = #methods;
        }
    })
}

/// `impl DiscreteRayleigh<Midpoint, 2> for Ring`; nothing where the rule's force has no R_d.
pub fn discrete_rayleigh(system: &System<'_>, rule: Rule) -> TokenStream {
    if !rule.has_discrete_rayleigh(system.degrees.literal()) {
        return TokenStream::new();
    }
    let as_trait = rule.joint().map(|_| quote!(JointRayleighRule));
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let subject = subject(system, system.home());
    let rayleigh = rule.entry().rayleigh;
    let rule = rule.ident();
    let functions = as_trait.map_or_else(|| quote!(#rule), |joint| quote!(<#rule as #joint>));
    quote! {
        #[automatically_derived]
        impl DiscreteRayleigh<#rule, #n> for #subject {
            #[doc = #rayleigh]
            fn discrete_rayleigh(&self, q0: &Vector, q1: &Vector, h: #scalar) -> #scalar {
                #functions::discrete_rayleigh(self, q0, q1, h)
            }

            /// R_d with D1, D2, D11, D12, D22.
            fn discrete_rayleigh_derivatives(
                &self,
                q0: &Vector,
                q1: &Vector,
                h: #scalar,
            ) -> Derivatives<#scalar, #n> {
                #functions::discrete_rayleigh_derivatives(self, q0, q1, h)
            }
        }
    }
}
