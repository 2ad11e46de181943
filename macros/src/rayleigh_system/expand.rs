//! From the checked system and its rewritten bodies to the implementation by num-dual.
//!
//! The comment above each quotation shows what it expands to.

mod derivatives;
pub mod lowered;

use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};
use syn::{FnArg, ImplItem, ImplItemFn, ItemImpl, Pat, Receiver, Type, parse_quote};

use super::check::Field;
use super::dual_numbers;
use super::implement::{self, discrete, discrete_rayleigh};
use super::imports::imported;
use super::item;
use super::item::{conditions, lints, parameters, quiet, structure};
use super::lower::{Lowered, Refusal};
use super::model::{Function, Part, RayleighArguments, Source, System};
use super::rewrite::{Twin, over};
use super::structure::{Engine, Structure};
use super::syntax::has_floats;
use super::view;

/// Where the functions over dual numbers come from.
pub enum Twins<'t> {
    /// The user's bodies, rewritten.
    Rewritten(&'t [Twin]),
    /// The expressions that the bodies compute, where rewriting them would need more than numbers.
    Lowered(&'t Lowered),
}

/// The whole expansion: the user's item, its functions over dual numbers, and the system that they make.
pub fn system(
    system: &System<'_>,
    twins: &Twins<'_>,
    refusal: Option<Refusal>,
    is_portable: bool,
) -> TokenStream {
    let (item, twins) = match (twins, system.source) {
        (Twins::Rewritten(twins), Source::Block(block)) => {
            (plain_block(system, &block.item, twins), twins_of_block(system, &block.item, twins))
        }
        (Twins::Rewritten(twins), Source::Function(function)) => {
            (function_and_struct(system, function), twins_of_function(system, function, &twins[0]))
        }
        (Twins::Lowered(lowered), _) => {
            (item::as_written(system, &lowered.functions, is_portable), lowered::twins(system, lowered))
        }
    };
    let imports = imports(system);
    let (scalar, n) = (&system.scalar, system.degrees.times(1));
    let conditions = conditions(system.source);
    let (quiet, quiet_twins) = (quiet(), quiet_twins());
    let both = RayleighArguments::ConfigurationAndVelocity;
    let warning = refusal.as_ref().map(|refusal| dual_numbers::warning(system, refusal));
    let bound = dual_numbers::bound(system);
    let structure = Structure { engine: Engine::NumDual(refusal), findings: None };
    let lagrangian =
        implement::lagrangian(system, &structure, derivatives::of_function(system, Part::Lagrangian, both));
    let rayleigh = system.rayleigh.map(|arguments| {
        implement::rayleigh(system, arguments, derivatives::of_function(system, Part::Rayleigh, arguments))
    });
    let force = system.has_force.then(|| implement::force(system, derivatives::of_force(system)));
    let forced = system.rules.gauss.then(|| implement::forced_lagrangian(system, None));
    let driven = implement::driven(system, derivatives::by_input(system));
    let second = system.second.then(|| implement::second_order(system, derivatives::along_vectors(system)));
    let view = view::definition(system);
    let offered_methods = implement::offered_methods(system, false);
    let discrete = system.rules.of_displacement.iter().map(|&rule| {
        let discrete = discrete(system, rule, false, None);
        let discrete_rayleigh = system.rayleigh.map(|_| discrete_rayleigh(system, rule));
        quote!(#discrete #discrete_rayleigh)
    });
    // Bodies stand apart from the implementations: the fewer names are imported beside a user's code, the
    // fewer collide.
    quote! {
        #item

        #warning

        #bound

        #view

        #(#conditions)*
        #quiet_twins
        const _: () = {
            use ::dalembert::generated::dual::{self, Dual, Real};
            #twins
        };

        #(#conditions)*
        #quiet
        const _: () = {
            #imports

            type Vector = SVector<#scalar, #n>;

            #lagrangian
            #rayleigh
            #force
            #forced
            #driven
            #second
            #(#discrete)*
            #offered_methods
        };
    }
}

/// The whole expansion of a field: the user's function, the struct of its parameters, and the field that it
/// is.
pub fn field(system: &System<'_>, twin: &Twin, function: &Function, kind: Field) -> TokenStream {
    let System { name, scalar, .. } = system;
    let n = system.degrees.times(1);
    let item = function_and_struct(system, function);
    let conditions = conditions(system.source);
    let (quiet, quiet_twins) = (quiet(), quiet_twins());
    let twin_name = &twin.over.sig.ident;
    let twin = written(twin, true);
    let lifted: Vec<_> = parameters(function).map(|(field, _)| quote!(D::lift(self.#field))).collect();
    let result = match kind {
        Field::Vector => quote!([Real<D>; #n]),
        Field::Scalar => quote!(Real<D>),
    };
    let plain = &function.item.sig.ident;
    let fields = parameters(function).map(|(field, _)| quote!(self.#field));
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

/// The user's bodies over dual numbers: rustc checks them there, and there alone.
fn quiet_twins() -> TokenStream {
    quote!(#[allow(clippy::pedantic, clippy::nursery)])
}

/// What the implementations use, and nothing else: an unused import would warn in the user's crate.
fn imports(system: &System<'_>) -> TokenStream {
    let names = imported(system);
    quote! {
        use ::dalembert::nalgebra::{SMatrix, SVector};
        use ::dalembert::generated::{#(#names,)* dual};
    }
}

/// The user's block, each differentiated function handing its work to the twin.
fn plain_block(system: &System<'_>, block: &ItemImpl, twins: &[Twin]) -> TokenStream {
    let mut block = block.clone();
    for item in &mut block.items {
        if let ImplItem::Fn(function) = item
            && twins.iter().any(|twin| twin.plain.sig.ident == function.sig.ident)
        {
            plain(system, function);
        }
    }
    block.into_token_stream()
}

/// The differentiated functions over `Real<D>`, in the order of the block.
fn twins_of_block(system: &System<'_>, block: &ItemImpl, twins: &[Twin]) -> TokenStream {
    let name = &system.name;
    let attributes = lints(&block.attrs);
    let twins = system.source.functions().filter_map(|function| {
        let twin = twins.iter().find(|twin| twin.plain.sig.ident == function.sig.ident)?;
        Some(written(twin, is_root(function)))
    });
    // Where nobody makes a value of the type, rustc says so at the type; the twins add nothing to that.
    quote! {
        #(#attributes)*
        #[allow(dead_code)]
        impl #name { #(#twins)* }
    }
}

/// `fn height(&self, x: f64) -> f64 { use ::dalembert::generated::dual;
/// dual::lower(self.height_over::<f64>(dual::lift(x))) }`
fn plain(system: &System<'_>, function: &mut ImplItemFn) {
    let scalar = &system.scalar;
    let name = over(&function.sig.ident);
    // The user's own `self`: one of the macro's would be another variable where a `macro_rules!` wrote the
    // attribute.
    let callee = match function.sig.receiver() {
        Some(Receiver { self_token, .. }) => quote!(#self_token.#name::<#scalar>),
        None => quote!(Self::#name::<#scalar>),
    };
    let arguments = lifted_arguments(function.sig.inputs.iter_mut());
    function.attrs.retain(|attribute| !attribute.path().is_ident("expect"));
    function.attrs.push(parse_quote!(#[allow(clippy::used_underscore_binding)]));
    // Bodies call the twins: a private helper may have no other caller.
    if !is_root(function) {
        function.attrs.push(parse_quote!(#[allow(dead_code)]));
    }
    function.block = parse_quote!({
        use ::dalembert::generated::dual;
        dual::lower(#callee(#(#arguments),*))
    });
}

/// The arguments of the twin; patterns that are no plain name become one.
fn lifted_arguments<'p>(parameters: impl Iterator<Item = &'p mut FnArg>) -> Vec<TokenStream> {
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
                    ty if !has_floats(ty) => quote!(#name),
                    Type::Reference(_) => quote!(&dual::lift(*#name)),
                    _ => quote!(dual::lift(#name)),
                })
            }
        })
        .collect()
}

/// Whether the function is L, R or f, and not a helper that they call.
fn is_root(function: &ImplItemFn) -> bool {
    ["lagrangian", "rayleigh", "force"].iter().any(|root| function.sig.ident == root)
}

/// The function over `Real<D>`, with the lint levels that the user set for its body.
fn written(twin: &Twin, is_root: bool) -> TokenStream {
    let Twin { plain, over, .. } = twin;
    let text = format!(" `{}` over plain and dual numbers.", plain.sig.ident);
    let attributes = lints(&plain.attrs);
    // L, R and f are called from one closure for each kind of number: called, they would hide from the
    // compiler which derivatives are absent.
    let inline = if is_root { quote!(#[inline(always)]) } else { quote!(#[inline]) };
    quote! {
        #[doc = #text]
        #inline
        #(#attributes)*
        #over
    }
}

/// The user's function, callable as before, and the struct of its parameters.
fn function_and_struct(system: &System<'_>, function: &Function) -> TokenStream {
    let name = &system.name;
    let mut plain = function.item.clone();
    let scalar = &system.scalar;
    let twin = over(&function.item.sig.ident);
    let arguments = lifted_arguments(plain.sig.inputs.iter_mut());
    plain.attrs.retain(|attribute| !attribute.path().is_ident("expect"));
    plain.block = parse_quote!({
        use ::dalembert::generated::dual;
        dual::lower(#name::#twin::<#scalar>(#(#arguments),*))
    });
    let structure = structure(system, function);
    quote! {
        #plain

        #structure
    }
}

/// The function's twin, and L and R taken out of it.
fn twins_of_function(system: &System<'_>, function: &Function, twin: &Twin) -> TokenStream {
    let System { name, scalar, .. } = system;
    let n = system.degrees.times(1);
    let twin_name = &twin.over.sig.ident;
    let twin = written(twin, true);
    let lifted: Vec<_> = parameters(function).map(|(field, _)| quote!(D::lift(self.#field))).collect();
    let part = |name: &str, text: &str, index: Option<TokenStream>| {
        let name = format_ident!("{name}_over");
        let index = index.map(|index| quote!(.#index));
        // fn lagrangian_over<D: Dual<f64>>(&self, q: …, v: …) -> Real<D> { Self::oscillator_over(q, v,
        // D::lift(self.m)).0 }
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
        #[allow(dead_code)]
        impl #name {
            #twin
            #lagrangian
            #rayleigh
        }
    }
}
