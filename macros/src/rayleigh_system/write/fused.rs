//! The step of a system by a rule: `Fused`, and the methods that an error can be asked of.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::super::emit::inlined;
use super::super::model::System;
use super::super::rules::Rule;
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
    /// Components of the kinks of R that the step takes apart from the rest.
    pub friction: usize,
}

/// The memory of a run.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Memory {
    Velocities,
    Matrix,
    Explicit,
    /// The type of that name in the runtime.
    OfRule(&'static str),
}

/// `impl Fused<Midpoint, 2> for Ring`: one term for each of L, R and f that the system has, unless an engine
/// gives the kernel's bodies. `may_cancel`: whether terms of the equations of motion can.
pub fn fused(
    system: &System<'_>,
    rule: Rule,
    (is_expanded, may_cancel): (bool, bool),
    kernel: Option<Kernel>,
) -> TokenStream {
    let cancelling_terms =
        (may_cancel && rule.asks_for_cancelling_terms()).then(|| cancelling_terms(system, rule));
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let subject = subject(system, system.home());
    let name = rule.ident();
    let Kernel { step_kernel, momenta, diagonals, is_linear, memory, explicit, friction } =
        kernel.unwrap_or_else(|| of_terms(system, rule));
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
        // A step on constraints is never explicit.
        Memory::Explicit if system.is_constrained() => {
            quote!(::dalembert::generated::KeptMatrix<#scalar, Self::Matrix, #n>)
        }
        Memory::Matrix => quote!(::dalembert::generated::KeptMatrix<#scalar, Self::Matrix, #n>),
        Memory::Explicit => quote!(::dalembert::generated::ExplicitMemory<#scalar, Self::Matrix, #n>),
        Memory::OfRule(name) => {
            let name = format_ident!("{name}");
            quote!(::dalembert::generated::#name<#scalar, #n>)
        }
    };
    let border = if system.is_constrained() {
        let m = system.constraint_count();
        quote!(::dalembert::generated::Constraints<#m>)
    } else if friction > 0 {
        let components = Literal::usize_unsuffixed(friction);
        quote!(::dalembert::generated::Friction<#components>)
    } else {
        let border = format_ident!("{}", rule.joint().map_or("Free", |joint| joint.border));
        quote!(::dalembert::generated::#border)
    };
    let linear = is_linear.then(|| {
        quote!(
            const LINEAR: bool = true;
        )
    });
    // impl Explicit<2> for Ring
    let explicit = explicit.filter(|_| !system.is_constrained());
    let explicit = explicit.map(|functions| {
        quote! {
            #[automatically_derived]
            impl ::dalembert::generated::Explicit<#n> for #subject {
                #functions
            }
        }
    });
    let written_out = (is_expanded && rule.joint().is_none()).then(|| {
        quote!(
            const WRITTEN_OUT: bool = true;
        )
    });
    quote! {
        #[automatically_derived]
        impl Fused<#name, #n> for #subject {
            type Matrix = #matrix;
            type Memory = #memory;
            type Border = #border;
            #linear
            #written_out

            /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄.
            #inline_kernel
            fn step_kernel(&self, segment: &Segment<#scalar, #n>) -> #kernel {
                #step_kernel
            }

            /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
            #inline_momenta
            fn momenta(&self, segment: &Segment<#scalar, #n>) -> Momenta<#scalar, #n> {
                #momenta
            }

            #cancelling_terms
        }

        #explicit
    }
}

/// Whether some function is a rule's own, as [`of_terms`] and [`cancelling_terms`] write it.
pub fn asks_rules(system: &System<'_>, may_cancel: bool, kernels: &[Option<Kernel>]) -> bool {
    system.rules.of_displacement.iter().zip(kernels).any(|(rule, kernel)| {
        let asks = kernel.is_none() || may_cancel && rule.asks_for_cancelling_terms();
        rule.joint().is_none() && asks
    })
}

/// The step by the functions of the rule: a term for each of L, R and f that the system has, or L and R
/// together.
fn of_terms(system: &System<'_>, rule: Rule) -> Kernel {
    let name = rule.ident();
    let joint = rule.joint();
    // Midpoint::lagrangian_kernel(self, segment) + Midpoint::rayleigh_kernel(self, segment)
    let terms = |function: &str| {
        let terms = system.terms().map(|part| format_ident!("{}_{function}", part.name()));
        quote!(#(#name::#terms(self, segment))+*)
    };
    let [step_kernel, momenta] = match joint {
        Some(_) => [quote!(step_kernel), quote!(momenta)]
            .map(|function| quote!(<#name as JointRule>::#function(self, segment))),
        None => ["kernel", "momenta"].map(terms),
    };
    Kernel {
        step_kernel,
        momenta,
        diagonals: None,
        is_linear: joint.is_some_and(|joint| joint.is_linear),
        memory: joint.map_or(Memory::Velocities, |joint| Memory::OfRule(joint.memory)),
        explicit: None,
        friction: 0,
    }
}

/// `fn cancelling_terms`, by the rule.
fn cancelling_terms(system: &System<'_>, rule: Rule) -> TokenStream {
    let (scalar, n, name) = (&system.scalar, system.degrees.times(1), rule.ident());
    let functions = match rule {
        // Its smooth part is that of the midpoint rule.
        Rule::Proximal => quote!(::dalembert::generated::Midpoint),
        _ if rule.joint().is_some() => quote!(<#name as JointRule>),
        _ => quote!(#name),
    };
    quote! {
        /// Sizes of the terms that cancel in p0, at rest for instance.
        #[cold]
        fn cancelling_terms(&self, segment: &Segment<#scalar, #n>) -> Vector {
            #functions::cancelling_terms(self, segment)
        }
    }
}

/// `impl OffersMethods<2> for Ring`: what an error can be asked of.
pub fn offered_methods(system: &System<'_>, is_explicit: bool) -> Option<TokenStream> {
    let mut rules = system.rules.of_displacement.iter();
    let is_explicit = is_explicit && !system.is_constrained();
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
