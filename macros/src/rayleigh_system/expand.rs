//! From the checked and rewritten system to its implementation.
//!
//! Each function below writes one `impl`; the comment above each quotation shows what it expands to.

use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};
use syn::{FnArg, Ident, ImplItem, ImplItemFn, Pat, Type, parse_quote};

use super::model::{Body, Function, RayleighArguments, Rule, Source, System};
use super::rewrite::over;

/// The whole expansion.
pub fn system(system: &System<'_>) -> TokenStream {
    let outside = match system.source {
        Source::Block(_) => TokenStream::new(),
        Source::Function(function) => function_and_struct(system, function),
    };
    let imports = imports(system);
    let bodies = match system.source {
        Source::Block(block) => annotated_block(system, block.item.clone()),
        Source::Function(function) => function_bodies(system, function),
    };
    let lagrangian = lagrangian(system);
    let rayleigh = system.rayleigh.map(|_| rayleigh(system));
    let force = system.has_force.then(|| force(system));
    let discrete = system.rules.iter().map(|&rule| discrete(system, rule, None));
    let discrete_rayleigh = system
        .rayleigh
        .map(|_| system.rules.iter().map(|&rule| discrete_rayleigh(system, rule)).collect::<TokenStream>());
    // const _: () = { use …; impl Ring { … } impl Lagrangian<2> for Ring { … } … };
    quote! {
        #outside
        const _: () = {
            #imports
            #bodies
            #lagrangian
            #rayleigh
            #force
            #(#discrete)*
            #discrete_rayleigh
        };
    }
}

/// What the expansion uses, and nothing else: an unused import would warn in the user's crate.
fn imports(system: &System<'_>) -> TokenStream {
    let names = imported(system);
    let linear = if system.has_force { quote!({SMatrix, SVector}) } else { quote!(SVector) };
    quote! {
        use ::dalembert::dual::{self, Dual, Real};
        use ::dalembert::nalgebra::#linear;
        use ::dalembert::{#(#names),*};
    }
}

/// The names of the runtime's own items among them.
pub fn imported(system: &System<'_>) -> Vec<Ident> {
    let mut names = vec![
        "Derivatives",
        "Direction",
        "Discrete",
        "DisplacementRule",
        "Gradient",
        "Lagrangian",
        "Momenta",
        "StepKernel",
        "Variations",
    ];
    if system.rayleigh.is_some() {
        names.extend(["DiscreteRayleigh", "Rayleigh"]);
    }
    if system.has_force {
        names.extend(["CovectorDerivatives", "Force"]);
    }
    if system.rayleigh.is_some() || system.has_force {
        names.extend(["DiscreteForce", "DiscreteForceDerivatives"]);
    }
    for rule in &system.rules {
        names.push(rule.name());
    }
    names.sort_unstable();
    names.into_iter().map(|name| format_ident!("{name}")).collect()
}

/// The user's block, each differentiated function followed by its twin over `Real<D>`.
fn annotated_block(system: &System<'_>, mut block: syn::ItemImpl) -> TokenStream {
    block.items = block
        .items
        .into_iter()
        .flat_map(|item| {
            let body = match &item {
                ImplItem::Fn(function) => {
                    system.bodies.iter().find(|body| body.plain.sig.ident == function.sig.ident)
                }
                _ => None,
            };
            match body {
                Some(body) => vec![
                    ImplItem::Fn(plain(system, body)),
                    ImplItem::Fn(documented_twin(body, is_root(body))),
                ],
                None => vec![item],
            }
        })
        .collect();
    block.into_token_stream()
}

/// `fn height(&self, x: f64) -> f64 { dual::lower(self.height_over::<f64>(dual::lift(x))) }`
fn plain(system: &System<'_>, body: &Body) -> ImplItemFn {
    let mut function = body.plain.clone();
    if !is_root(body) {
        // A private helper that L alone calls would count as dead: L calls its twin.
        function.attrs.push(parse_quote!(#[allow(dead_code)]));
    }
    let scalar = &system.scalar;
    let name = over(&function.sig.ident);
    let arguments = lifted_arguments(function.sig.inputs.iter_mut(), &quote!(dual));
    let callee = match function.sig.receiver() {
        Some(_) => quote!(self.#name::<#scalar>),
        None => quote!(Self::#name::<#scalar>),
    };
    function.block = parse_quote!({ dual::lower(#callee(#(#arguments),*)) });
    function
}

/// The arguments of the twin; patterns that are no plain name become one.
fn lifted_arguments<'p>(
    parameters: impl Iterator<Item = &'p mut FnArg>,
    dual: &TokenStream,
) -> Vec<TokenStream> {
    parameters
        .enumerate()
        .filter_map(|(index, parameter)| match parameter {
            FnArg::Receiver(_) => None,
            FnArg::Typed(parameter) => {
                let name = match &*parameter.pat {
                    Pat::Ident(pattern) => pattern.ident.clone(),
                    _ => format_ident!("argument_{index}"),
                };
                // The twin alone changes a `mut` parameter.
                *parameter.pat = parse_quote!(#name);
                Some(match &*parameter.ty {
                    Type::Reference(_) => quote!(&#dual::lift(*#name)),
                    _ => quote!(#dual::lift(#name)),
                })
            }
        })
        .collect()
}

/// Whether the function is L, R or f, and not a helper that they call.
fn is_root(body: &Body) -> bool {
    ["lagrangian", "rayleigh", "force"].iter().any(|root| body.plain.sig.ident == root)
}

fn documented_twin(body: &Body, is_root: bool) -> ImplItemFn {
    let mut twin = body.over.clone();
    let text = format!(" `{}` over plain and dual numbers.", body.plain.sig.ident);
    twin.attrs.push(parse_quote!(#[doc = #text]));
    // L, R and f are called from one closure for each kind of number: called, they would hide from the compiler which
    // derivatives are absent.
    twin.attrs.push(if is_root { parse_quote!(#[inline(always)]) } else { parse_quote!(#[inline]) });
    twin
}

/// The user's function, callable as before, and the struct of its parameters.
fn function_and_struct(system: &System<'_>, function: &Function) -> TokenStream {
    let name = &system.name;
    let function_name = &function.item.sig.ident;
    let structure = structure(system, function);
    let mut plain = function.item.clone();
    let scalar = &system.scalar;
    let twin = over(function_name);
    let arguments = lifted_arguments(plain.sig.inputs.iter_mut(), &quote!(::dalembert::dual));
    plain.block = parse_quote!({ ::dalembert::dual::lower(#name::#twin::<#scalar>(#(#arguments),*)) });
    quote! {
        #plain

        #structure
    }
}

/// The struct of a free function's parameters.
pub fn structure(system: &System<'_>, function: &Function) -> TokenStream {
    let name = &system.name;
    let visibility = function.visibility();
    let function_name = &function.item.sig.ident;
    let text = format!(" The mechanical system of [`{function_name}`], with its parameters.");
    let fields = parameters(function).map(|(field, ty)| {
        let text = format!(" Parameter `{field}` of [`{function_name}`].");
        quote!(#[doc = #text] #visibility #field: #ty)
    });
    let body = if parameters(function).next().is_some() { quote!({ #(#fields),* }) } else { quote!(;) };
    quote! {
        #[doc = #text]
        #[derive(Clone, Copy, Debug, PartialEq)]
        #visibility struct #name #body
    }
}

/// The function's twin, and L and R taken out of it.
fn function_bodies(system: &System<'_>, function: &Function) -> TokenStream {
    let System { name, scalar, .. } = system;
    let n = system.degrees.times(1);
    let twin = documented_twin(&system.bodies[0], true);
    let twin_name = &twin.sig.ident;
    let lifted: Vec<_> = parameters(function).map(|(field, _)| quote!(D::lift(self.#field))).collect();
    let part = |name: &str, text: &str, index: Option<TokenStream>| {
        let name = format_ident!("{name}_over");
        let index = index.map(|index| quote!(.#index));
        // fn lagrangian_over<D: Dual<f64>>(&self, q: …, v: …) -> Real<D> { Self::oscillator_over(q, v, D::lift(self.m)).0 }
        quote! {
            #[doc = #text]
            #[inline(always)]
            fn #name<D: Dual<#scalar>>(&self, q: [Real<D>; #n], v: [Real<D>; #n]) -> Real<D> {
                Self::#twin_name(q, v, #(#lifted),*) #index
            }
        }
    };
    let of_pair = system.rayleigh.is_some();
    let lagrangian = part("lagrangian", " L over plain and dual numbers.", of_pair.then(|| quote!(0)));
    let rayleigh = of_pair
        .then(|| part("rayleigh", " The Rayleigh function over plain and dual numbers.", Some(quote!(1))));
    quote! {
        impl #name {
            #twin
            #lagrangian
            #rayleigh
        }
    }
}

/// Names and types of a free function's parameters after q and v.
fn parameters(function: &Function) -> impl Iterator<Item = (&Ident, &Type)> {
    function.item.sig.inputs.iter().skip(2).filter_map(|parameter| match parameter {
        FnArg::Typed(parameter) => match &*parameter.pat {
            Pat::Ident(pattern) => Some((&pattern.ident, &*parameter.ty)),
            _ => None,
        },
        FnArg::Receiver(_) => None,
    })
}

/// The plain value of L (0) or R (1) at the vectors q and v.
pub fn value(system: &System<'_>, function: &str, arguments: RayleighArguments) -> TokenStream {
    match system.source {
        Source::Block(_) => {
            let function = format_ident!("{function}");
            match arguments {
                RayleighArguments::Velocity => quote!(self.#function((*v).into())),
                RayleighArguments::ConfigurationAndVelocity => {
                    quote!(self.#function((*q).into(), (*v).into()))
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

/// `impl Lagrangian<2> for Ring`
fn lagrangian(system: &System<'_>) -> TokenStream {
    let System { name, scalar, .. } = system;
    let n = system.degrees.times(1);
    let functions = value_and_derivatives(system, "lagrangian", RayleighArguments::ConfigurationAndVelocity);
    quote! {
        #[automatically_derived]
        impl Lagrangian<#n> for #name {
            type Scalar = #scalar;
            #functions
        }
    }
}

/// `impl Rayleigh<2> for Ring`
fn rayleigh(system: &System<'_>) -> TokenStream {
    let name = &system.name;
    let n = system.degrees.times(1);
    let arguments = system.rayleigh.unwrap_or(RayleighArguments::ConfigurationAndVelocity);
    let functions = value_and_derivatives(system, "rayleigh", arguments);
    quote! {
        #[automatically_derived]
        impl Rayleigh<#n> for #name {
            #functions
        }
    }
}

/// Value, gradient, derivatives and variations of L or R.
fn value_and_derivatives(system: &System<'_>, function: &str, arguments: RayleighArguments) -> TokenStream {
    let System { scalar, .. } = system;
    let (n, twice) = (system.degrees.times(1), system.degrees.times(2));
    let value = value(system, function, arguments);
    let [plain, over, gradient, derivatives, variations] =
        ["", "_over", "_gradient", "_derivatives", "_variations"]
            .map(|suffix| format_ident!("{function}{suffix}"));
    let (unused, closure) = match arguments {
        RayleighArguments::Velocity => (quote!(_q), quote!(|_, v| self.#over(v))),
        RayleighArguments::ConfigurationAndVelocity => (quote!(q), quote!(|q, v| self.#over(q, v))),
    };
    // fn lagrangian_gradient(&self, q: …, v: …) -> Gradient<f64, 2> {
    //     dual::gradient::<f64, 2>(q, v, |q, v| self.lagrangian_over(q, v))
    // }
    quote! {
        fn #plain(&self, #unused: &SVector<#scalar, #n>, v: &SVector<#scalar, #n>) -> #scalar {
            #value
        }

        fn #gradient(&self, q: &SVector<#scalar, #n>, v: &SVector<#scalar, #n>) -> Gradient<#scalar, #n> {
            dual::gradient::<#scalar, #n>(q, v, #closure)
        }

        fn #derivatives(&self, q: &SVector<#scalar, #n>, v: &SVector<#scalar, #n>) -> Derivatives<#scalar, #n> {
            dual::derivatives::<#scalar, #n, #twice>(q, v, #closure)
        }

        fn #variations(
            &self,
            q: &SVector<#scalar, #n>,
            v: &SVector<#scalar, #n>,
            minus: Direction<#scalar>,
            plus: Direction<#scalar>,
        ) -> Variations<#scalar, #n> {
            dual::variations::<#scalar, #n>(q, v, minus, plus, #closure)
        }
    }
}

/// `impl Force<2> for Ring`
fn force(system: &System<'_>) -> TokenStream {
    let System { name, scalar, .. } = system;
    let (n, twice) = (system.degrees.times(1), system.degrees.times(2));
    quote! {
        #[automatically_derived]
        impl Force<#n> for #name {
            fn force(&self, q: &SVector<#scalar, #n>, v: &SVector<#scalar, #n>) -> SVector<#scalar, #n> {
                self.force((*q).into(), (*v).into()).into()
            }

            fn force_derivatives(
                &self,
                q: &SVector<#scalar, #n>,
                v: &SVector<#scalar, #n>,
            ) -> CovectorDerivatives<#scalar, #n> {
                dual::covector_derivatives::<#scalar, #n, #twice>(q, v, |q, v| self.force_over(q, v))
            }

            fn force_variation(
                &self,
                q: &SVector<#scalar, #n>,
                v: &SVector<#scalar, #n>,
                direction: Direction<#scalar>,
            ) -> (SVector<#scalar, #n>, SMatrix<#scalar, #n, #n>) {
                dual::covector_variation::<#scalar, #n>(q, v, direction, |q, v| self.force_over(q, v))
            }
        }
    }
}

/// Bodies of the functions that a step calls.
pub struct Kernel {
    pub step_kernel: TokenStream,
    /// Where p1 and its derivative come with the kernel.
    pub step_evaluation: Option<TokenStream>,
    pub momenta: TokenStream,
}

/// `impl Discrete<Midpoint, 2> for Ring`: one term for each of L, R and f that the system has.
///
/// An engine may give the kernel's bodies; without them each term is asked for its own.
pub fn discrete(system: &System<'_>, rule: Rule, kernel: Option<Kernel>) -> TokenStream {
    let System { name, scalar, .. } = system;
    let n = system.degrees.times(1);
    let rule = format_ident!("{}", rule.name());
    let vector = quote!(&SVector<#scalar, #n>);
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
            /// f_d = (f_d⁻, f_d⁺).
            fn discrete_force(&self, q0: #vector, q1: #vector, h: #scalar) -> DiscreteForce<#scalar, #n> {
                #(#rule::#forces(self, q0, q1, h))+*
            }

            /// f_d with its derivatives by q0 and q1.
            fn discrete_force_derivatives(
                &self,
                q0: #vector,
                q1: #vector,
                h: #scalar,
            ) -> DiscreteForceDerivatives<#scalar, #n> {
                #(#rule::#force_derivatives(self, q0, q1, h))+*
            }
        }
    });
    // p0 = −D1 L_d − f_d⁻: Midpoint::lagrangian_kernel(self, q0, v, h) + Midpoint::rayleigh_kernel(self, q0, v, h)
    let Kernel { step_kernel, step_evaluation, momenta } = kernel.unwrap_or_else(|| Kernel {
        step_kernel: quote!(#rule::lagrangian_kernel(self, q0, v, h) #(+ #rule::#kernels(self, q0, v, h))*),
        step_evaluation: None,
        momenta: quote!(#rule::lagrangian_momenta(self, q0, v, h) #(+ #rule::#momenta(self, q0, v, h))*),
    });
    let step_evaluation = step_evaluation.map(|step_evaluation| {
        quote! {
            /// The kernel, and p1 with ∂p1/∂v̄.
            #[inline]
            fn step_evaluation(
                &self,
                q0: #vector,
                v: #vector,
                h: #scalar,
            ) -> (StepKernel<#scalar, #n>, Option<::dalembert::Outgoing<#scalar, #n>>) {
                #step_evaluation
            }
        }
    });
    quote! {
        #[automatically_derived]
        impl Discrete<#rule, #n> for #name {
            /// L_d(q0, q1, h).
            fn discrete_lagrangian(&self, q0: #vector, q1: #vector, h: #scalar) -> #scalar {
                #rule::discrete_lagrangian(self, q0, q1, h)
            }

            /// L_d with D1, D2, D11, D12, D22.
            fn discrete_lagrangian_derivatives(
                &self,
                q0: #vector,
                q1: #vector,
                h: #scalar,
            ) -> Derivatives<#scalar, #n> {
                #rule::discrete_lagrangian_derivatives(self, q0, q1, h)
            }

            #discrete_force

            /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄, at q1 = q0 + h v̄.
            #[inline]
            fn step_kernel(&self, q0: #vector, v: #vector, h: #scalar) -> StepKernel<#scalar, #n> {
                #step_kernel
            }

            #step_evaluation

            /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺, at q1 = q0 + h v̄.
            #[inline]
            fn momenta(&self, q0: #vector, v: #vector, h: #scalar) -> Momenta<#scalar, #n> {
                #momenta
            }

            /// E_L on the segment.
            fn segment_energy(&self, q0: #vector, q1: #vector, h: #scalar) -> #scalar {
                #rule::segment_energy(self, q0, q1, h)
            }
        }
    }
}

/// `impl DiscreteRayleigh<Midpoint, 2> for Ring`
pub fn discrete_rayleigh(system: &System<'_>, rule: Rule) -> TokenStream {
    let System { name, scalar, .. } = system;
    let n = system.degrees.times(1);
    let rule = format_ident!("{}", rule.name());
    let vector = quote!(&SVector<#scalar, #n>);
    quote! {
        #[automatically_derived]
        impl DiscreteRayleigh<#rule, #n> for #name {
            /// R_d(q0, q1, h).
            fn discrete_rayleigh(&self, q0: #vector, q1: #vector, h: #scalar) -> #scalar {
                #rule::discrete_rayleigh(self, q0, q1, h)
            }

            /// R_d with D1, D2, D11, D12, D22.
            fn discrete_rayleigh_derivatives(
                &self,
                q0: #vector,
                q1: #vector,
                h: #scalar,
            ) -> Derivatives<#scalar, #n> {
                #rule::discrete_rayleigh_derivatives(self, q0, q1, h)
            }
        }
    }
}
