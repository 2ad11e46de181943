//! The traits of the runtime, implemented for a system: each function below writes one `impl`, and the
//! comment above each quotation shows what it expands to.

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};

use super::item::parameters;
use super::model::{Home, Part, RayleighArguments, Rule, Source, System};
use super::structure::{Engine, Structure};
use super::view::{self, arguments, owner, subject};

/// The plain value of L (0) or R (1) at the vectors q and v.
fn value(system: &System<'_>, part: Part, point: RayleighArguments) -> TokenStream {
    let function = part.name();
    match system.source {
        Source::Block(_) => {
            let function = format_ident!("{function}");
            let (owner, after) = (owner(system.home_of(part)), arguments(system, part));
            match point {
                RayleighArguments::Velocity => quote!(#owner.#function((*v).into() #(, #after)*)),
                RayleighArguments::ConfigurationAndVelocity => {
                    quote!(#owner.#function((*q).into(), (*v).into() #(, #after)*))
                }
            }
        }
        Source::Function(source) => {
            let name = &source.item.sig.ident;
            let fields = parameters(source).map(|(field, _)| quote!(self.#field));
            let index = match (system.rayleigh, function) {
                (None, _) => None,
                (Some(_), "lagrangian") => Some(quote!(.0)),
                (Some(_), _) => Some(quote!(.1)),
            };
            quote!(#name((*q).into(), (*v).into(), #(#fields),*) #index)
        }
    }
}

/// `impl Lagrangian<2> for Ring`, with the derivatives of either engine.
pub fn lagrangian(system: &System<'_>, structure: &Structure, derivatives: TokenStream) -> TokenStream {
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let home = system.home_of(Part::Lagrangian);
    let subject = subject(system, home);
    let later = if home == Home::View { view::later(system) } else { None };
    let value = value(system, Part::Lagrangian, RayleighArguments::ConfigurationAndVelocity);
    let is_expanded = matches!(structure.engine, Engine::Expanded);
    let verification = is_expanded.then(|| verification(system, home));
    let delegation = view::delegation(system, Part::Lagrangian, verification_of_view(system, is_expanded));
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

            #verification

            #later
        }

        #delegation
    }
}

/// `fn verify_generated`: those of L, R and f that `home` has.
fn verification(system: &System<'_>, home: Home) -> TokenStream {
    let parts = parts(system).filter(|&part| home == Home::View || system.home_of(part) == home);
    let functions: Vec<_> = parts.map(|part| format_ident!("{}", part.name())).collect();
    let Some((last, others)) = functions.split_last() else { return TokenStream::new() };
    // verification::lagrangian(self, q, v)?; verification::rayleigh(self, q, v)
    quote! {
        fn verify_generated(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::result::Result<(), ::dalembert::generated::GeneratedDiffers> {
            #(::dalembert::generated::verification::#others(self, q, v)?;)*
            ::dalembert::generated::verification::#last(self, q, v)
        }
    }
}

/// That of the view, where the system itself has one of its own.
fn verification_of_view(system: &System<'_>, is_expanded: bool) -> Option<TokenStream> {
    (is_expanded && system.has_view()).then(|| verification(system, Home::View))
}

/// `impl Rayleigh<2> for Ring`, with the derivatives of either engine.
pub fn rayleigh(system: &System<'_>, point: RayleighArguments, derivatives: TokenStream) -> TokenStream {
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let subject = subject(system, system.home_of(Part::Rayleigh));
    let value = value(system, Part::Rayleigh, point);
    let delegation = view::delegation(system, Part::Rayleigh, None);
    let q = match point {
        RayleighArguments::Velocity => quote!(_q),
        RayleighArguments::ConfigurationAndVelocity => quote!(q),
    };
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
    let home = system.home_of(Part::Force);
    let (subject, owner, after) = (subject(system, home), owner(home), arguments(system, Part::Force));
    quote! {
        #[automatically_derived]
        impl Force<#n> for #subject {
            #[inline]
            fn force(&self, q: &Vector, v: &Vector) -> Vector {
                #owner.force((*q).into(), (*v).into() #(, #after)*).into()
            }

            #derivatives
        }
    }
}

/// `impl ForcedLagrangian<2> for Ring`: one term for each of R and f that the system has. The equations of
/// motion at the stages are those that the runtime makes of it, unless an engine gives them.
pub fn forced_lagrangian(system: &System<'_>, stages: Option<TokenStream>) -> TokenStream {
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let subject = subject(system, system.home());
    let general = |derivatives: bool| {
        system.has_force.then(|| match derivatives {
            true => quote!(self.force_derivatives(q, v)),
            false => quote!(Force::force(self, q, v)),
        })
    };
    let of_rayleigh = |term: TokenStream| system.rayleigh.map(|_| term);
    // −∂R/∂v + f
    let values = [of_rayleigh(quote!(-self.rayleigh_gradient(q, v).d2)), general(false)];
    let r = of_rayleigh(quote!(let r = self.rayleigh_derivatives(q, v);));
    let derivatives = [
        of_rayleigh(quote!(CovectorDerivatives { value: -r.d2, d1: -r.d12.transpose(), d2: -r.d22 })),
        general(true),
    ];
    let (values, derivatives) = (values.iter().flatten(), derivatives.iter().flatten());
    let is_forced = system.rayleigh.is_some() || system.has_force;
    let formula = match (system.rayleigh.is_some(), system.has_force) {
        (true, false) => " f_L = −∂R/∂v.",
        (true, true) => " f_L = −∂R/∂v + f.",
        (false, _) => " f_L = f.",
    };
    let force = is_forced.then(|| {
        quote! {
            const IS_FORCED: bool = true;

            #[doc = #formula]
            #[inline]
            fn acting_force(&self, q: &Vector, v: &Vector) -> Vector {
                #(#values)+*
            }

            /// f_L with its derivatives by q and v.
            #[inline]
            fn acting_force_derivatives(
                &self,
                q: &Vector,
                v: &Vector,
            ) -> CovectorDerivatives<#scalar, #n> {
                #r
                #(#derivatives)+*
            }
        }
    });
    let timed = system.timed.any().then(|| {
        quote!(
            const IS_TIMED: bool = true;
        )
    });
    quote! {
        #[automatically_derived]
        impl ForcedLagrangian<#n> for #subject {
            #timed
            #force
            #stages
        }
    }
}

/// `impl Driven<2, 1> for DrivenArm<'_>`, with the body of either engine.
pub fn driven(system: &System<'_>, by_input: TokenStream) -> Option<TokenStream> {
    let scalar = &system.scalar;
    let (n, m) = (system.degrees.times(1), system.input.as_ref()?.times(1));
    let subject = subject(system, Home::View);
    let rules = system.rules.of_displacement.iter().map(|rule| format_ident!("{}", rule.name()));
    Some(quote! {
        #[automatically_derived]
        impl Driven<#n, #m> for #subject {
            #by_input
        }

        #(
            #[automatically_derived]
            impl DiscreteDriven<#rules, #n, #m> for #subject {
                /// ∂p0/∂u = −∂f_d⁻/∂u and ∂p1/∂u = ∂f_d⁺/∂u.
                fn momenta_by_input(&self, q0: &Vector, v: &Vector, h: #scalar) -> MomentaBy<#scalar, #n, #m> {
                    #rules::force_by_input(self, q0, v, h)
                }
            }
        )*
    })
}

/// `impl Parameters<2, 3> for Ring`, with the functions given.
pub fn by_parameters(system: &System<'_>, functions: TokenStream) -> TokenStream {
    let scalar = &system.scalar;
    let (n, p) = (system.degrees.times(1), system.parameter_count());
    let subject = subject(system, system.home());
    let names =
        system.parameters.iter().map(|parameter| parameter.to_token_stream().to_string().replace(' ', ""));
    let terms: Vec<_> = parts(system).map(|part| format_ident!("{}_by_parameters", part.name())).collect();
    let rules = system.rules.of_displacement.iter().map(|rule| format_ident!("{}", rule.name()));
    let discrete = rules.map(|rule| {
        quote! {
            #[automatically_derived]
            impl DiscreteParameters<#rule, #n, #p> for #subject {
                /// ∂p0/∂θ and ∂p1/∂θ at fixed configurations.
                fn momenta_by_parameters(
                    &self,
                    q0: &Vector,
                    v: &Vector,
                    h: #scalar,
                ) -> MomentaBy<#scalar, #n, #p> {
                    #(#rule::#terms(self, q0, v, h))+*
                }
            }
        }
    });
    quote! {
        #[automatically_derived]
        impl Parameters<#n, #p> for #subject {
            const PARAMETERS: [&'static str; #p] = [#(#names),*];

            #functions
        }

        #(#discrete)*
    }
}

/// `impl SecondOrder<2, 1> for DrivenArm<'_>`, with the functions of either engine.
pub fn second_order(system: &System<'_>, functions: TokenStream) -> TokenStream {
    let scalar = &system.scalar;
    let (n, m) = (system.degrees.times(1), system.inputs());
    let subject = subject(system, system.home());
    let terms: Vec<_> = parts(system).map(|part| format_ident!("{}_along", part.name())).collect();
    let rules = system.rules.of_displacement.iter().map(|rule| format_ident!("{}", rule.name()));
    let discrete = rules.map(|rule| {
        let p0_by_input = system.input.is_some().then(|| {
            quote! {
                /// −∂f_d⁻/∂u.
                fn p0_by_input(&self, q0: &Vector, v: &Vector, h: #scalar) -> SMatrix<#scalar, #n, #m> {
                    #rule::force_by_input(self, q0, v, h).p0
                }
            }
        });
        quote! {
            #[automatically_derived]
            impl DiscreteSecondOrder<#rule, #n, #m> for #subject {
                /// Second derivatives of `at_start`·p0 + `at_end`·p1 by q0, q1 and u.
                fn momenta_along(
                    &self,
                    q0: &Vector,
                    v: &Vector,
                    h: #scalar,
                    at_start: &Vector,
                    at_end: &Vector,
                ) -> Hessian<#scalar, #n, #m> {
                    #(#rule::#terms(self, q0, v, h, [at_start, at_end]))+*
                }

                #p0_by_input
            }
        }
    });
    // What rules with interior points ask for besides.
    let by_input = (system.rules.gauss && system.input.is_some()).then(|| {
        quote! {
            #[inline]
            fn force_slope_by_input(&self, q: &Vector, v: &Vector) -> SMatrix<#scalar, #n, #m> {
                self.force_by_input(q, v)
            }
        }
    });
    quote! {
        #[automatically_derived]
        impl SecondOrder<#n, #m> for #subject {
            #functions
            #by_input
        }

        #(#discrete)*
    }
}

/// Those of L, R and f that the system has.
fn parts(system: &System<'_>) -> impl Iterator<Item = Part> {
    let rayleigh = system.rayleigh.map(|_| Part::Rayleigh);
    let force = system.has_force.then_some(Part::Force);
    [Part::Lagrangian].into_iter().chain(rayleigh).chain(force)
}

/// What an engine makes of the step's equation: bodies of the functions that a step calls, L, R and f
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
}

/// What a run keeps from step to step.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Memory {
    Velocities,
    Matrix,
    Explicit,
}

/// `impl Discrete<Midpoint, 2> for Ring`: one term for each of L, R and f that the system has, unless an
/// engine gives the kernel's bodies.
pub fn discrete(system: &System<'_>, rule: Rule, is_expanded: bool, kernel: Option<Kernel>) -> TokenStream {
    if rule.is_joint() {
        return joint(system, rule, is_expanded);
    }
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let subject = subject(system, system.home());
    let lagrangian = rule.lagrangian();
    let force = rule.force(system.rayleigh.is_some(), system.has_force);
    let rule = format_ident!("{}", rule.name());
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
    let Kernel { step_kernel, momenta, diagonals, is_linear, memory, explicit } = kernel.unwrap_or_else(|| Kernel {
        step_kernel: quote!(#rule::lagrangian_kernel(self, q0, v, h) #(+ #rule::#kernels(self, q0, v, h))*),
        momenta: quote!(#rule::lagrangian_momenta(self, q0, v, h) #(+ #rule::#momenta(self, q0, v, h))*),
        diagonals: None,
        is_linear: false,
        memory: Memory::Velocities,
        explicit: None,
    });
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
    let verification = is_expanded.then(|| segment_verification(system, &quote!(#rule)));
    // p0 = −D1 L_d − f_d⁻: Midpoint::lagrangian_kernel(self, q0, v, h) + Midpoint::rayleigh_kernel(self, q0,
    // v, h)
    quote! {
        #[automatically_derived]
        impl Discrete<#rule, #n> for #subject {
            type Matrix = #matrix;
            type Memory = #memory;
            #linear

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
            #[inline]
            fn step_kernel(&self, q0: &Vector, v: &Vector, h: #scalar) -> #kernel {
                #step_kernel
            }

            /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺, at q1 = q0 + h v̄.
            #[inline]
            fn momenta(&self, q0: &Vector, v: &Vector, h: #scalar) -> Momenta<#scalar, #n> {
                #momenta
            }

            /// E_L on the segment.
            fn segment_energy(&self, q0: &Vector, q1: &Vector, h: #scalar) -> #scalar {
                #rule::segment_energy(self, q0, q1, h)
            }

            #verification
        }

        #explicit
    }
}

/// `impl OffersMethods<2> for Ring`: what an error can be asked of.
pub fn offered_methods(system: &System<'_>, is_explicit: bool) -> Option<TokenStream> {
    let rules = &system.rules.of_displacement;
    let rule =
        if is_explicit { Some(&Rule::Trapezoidal) } else { rules.iter().find(|rule| rule.is_self_adjoint()) };
    let rule = format_ident!("{}", rule?.name());
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

/// `fn verify_segment`, by the nodes of the rule.
fn segment_verification(system: &System<'_>, rule: &TokenStream) -> TokenStream {
    let scalar = &system.scalar;
    quote! {
        fn verify_segment(
            &self,
            q0: &Vector,
            v: &Vector,
            h: #scalar,
        ) -> ::core::result::Result<(), ::dalembert::generated::GeneratedDiffers> {
            #rule::verify_segment(self, q0, v, h)
        }
    }
}

/// `impl Discrete<Fitted, 2> for Ring`: L and R together, one call each.
fn joint(system: &System<'_>, rule: Rule, is_expanded: bool) -> TokenStream {
    let System { name, scalar, .. } = system;
    let n = system.degrees.times(1);
    let (lagrangian, force) = (rule.lagrangian(), rule.force(true, false));
    // With a constant matrix and the potential at the ends, one correction solves the step.
    let linear = (rule == Rule::FittedTrapezoidal).then(|| {
        quote!(
            const LINEAR: bool = true;
        )
    });
    let memory = match rule {
        Rule::Fitted => quote!(DriftMemory),
        Rule::FittedTrapezoidal => quote!(ExplicitDriftMemory),
        _ => quote!(VelocityHistory),
    };
    let memory = quote!(::dalembert::generated::#memory<#scalar, #n>);
    let is_fitted = rule != Rule::OneSided;
    let rule = format_ident!("{}", rule.name());
    let verification = is_expanded.then(|| segment_verification(system, &quote!(<#rule as JointRule>)));
    // What depends on h alone is worked out once for all evaluations of a step.
    let steps = is_fitted.then(|| {
        quote! {
            /// The flow on T*Q, (q0, p0) ↦ (q1, p1).
            #[inline]
            fn step(
                &self,
                state: &::dalembert::generated::State<#scalar, #n>,
                h: #scalar,
                guess: ::core::option::Option<&Vector>,
            ) -> ::core::result::Result<::dalembert::generated::Step<#scalar, #n>, ::dalembert::generated::StepError> {
                #rule::step(self, state, h, guess)
            }

            /// The same by at most `iterations` of Newton's.
            fn step_within(
                &self,
                state: &::dalembert::generated::State<#scalar, #n>,
                h: #scalar,
                guess: ::core::option::Option<&Vector>,
                iterations: u32,
            ) -> ::core::result::Result<::dalembert::generated::BoundedStep<#scalar, #n>, ::dalembert::generated::StepError> {
                #rule::step_within(self, state, h, guess, iterations)
            }
        }
    });
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

            /// E_L on the segment.
            fn segment_energy(&self, q0: &Vector, q1: &Vector, h: #scalar) -> #scalar {
                <#rule as JointRule>::segment_energy(self, q0, q1, h)
            }

            #verification

            #steps
        }
    }
}

/// `impl DiscreteRayleigh<Midpoint, 2> for Ring`; nothing where the rule's force has no R_d.
pub fn discrete_rayleigh(system: &System<'_>, rule: Rule) -> TokenStream {
    if rule == Rule::Fitted && system.degrees.literal() != Some(1) {
        return TokenStream::new();
    }
    let as_trait = rule.is_joint().then(|| quote!(JointRayleighRule));
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let subject = subject(system, system.home());
    let rayleigh = rule.rayleigh();
    let rule = format_ident!("{}", rule.name());
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
