//! The stand-in for the expansion of a wrong system: the user's item, the diagnostics, and stubs of the
//! traits, so that one mistake gives one message and not one more for each use of the system. Bodies with
//! mistakes are left out: rustc would say the same in other words.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{FnArg, ImplItem, ImplItemFn, ReturnType, Signature, Type, parse_quote};

use super::diagnostics::Report;
use super::model::{Degrees, Lanes, Role, Source};
use super::parts::Part;
use super::rules::{Rule, Rules};
use super::syntax::simple_name;

/// The item as it came, beside the diagnostics.
pub fn item_alone(item: TokenStream, report: Report) -> TokenStream {
    let errors = report.to_tokens();
    quote!(#item #errors)
}

/// The item, the diagnostics and stubs, as far as the signature of L tells the number of degrees of freedom.
///
/// Stubs in lanes are among them, where lanes are asked for.
pub fn with_stubs(source: &Source, rules: &Rules, lanes: &Lanes, report: Report) -> TokenStream {
    let errors = report.to_tokens();
    let name = source.name();
    let (item, lagrangian) = match source {
        Source::Block(block) => {
            let lagrangian = source.functions().find(|function| function.sig.ident == "lagrangian");
            let mut item = block.item.clone();
            for function in &mut item.items {
                if let ImplItem::Fn(ImplItemFn { attrs, sig, block, .. }) = function
                    && report.has_mistakes_in(&sig.ident)
                {
                    attrs.push(parse_quote!(#[allow(unused, clippy::all)]));
                    *block = parse_quote!({ ::core::unreachable!() });
                }
            }
            (quote!(#item), lagrangian.map(|function| &function.sig))
        }
        Source::Function(function) => {
            let mut item = function.item.clone();
            if report.has_mistakes_in(&item.sig.ident) {
                item.attrs.push(parse_quote!(#[allow(unused, clippy::all)]));
                item.block = parse_quote!({ ::core::unreachable!() });
            }
            let visibility = function.visibility();
            let fields = function.fields().filter(|(_, ty)| !matches!(ty, Type::Reference(_)));
            let fields = fields.map(|(field, ty)| quote!(#visibility #field: #ty));
            let fields = quote!({ #(#fields),* });
            (quote!(#item #[allow(dead_code)] #visibility struct #name #fields), Some(&function.item.sig))
        }
    };
    let view = view_stub(source);
    let time_scale = time_scale_stub(source, lagrangian);
    let is_field = matches!(source, Source::Function(function) if function.role == Role::Field);
    let stubs = if is_field { field_stubs(source) } else { stubs_of(lagrangian, name, rules, lanes) };
    quote!(#item #errors #stubs #time_scale #view)
}

/// `driven` or `at_time`, as far as the signatures tell, with the system for the view: it has all stubs.
fn view_stub(source: &Source) -> Option<TokenStream> {
    // What stands after q and v.
    let after = |part: Part| {
        let function = source.functions().find(|function| function.sig.ident == part.name())?;
        let parameters = function.sig.inputs.iter().filter(|parameter| matches!(parameter, FnArg::Typed(_)));
        Some(parameters.skip(part.entry().takes.choose([(); 4]).count()))
    };
    let is_array =
        |parameter: &FnArg| matches!(parameter, FnArg::Typed(typed) if matches!(&*typed.ty, Type::Array(_)));
    let is_driven = after(Part::Force).into_iter().flatten().any(is_array);
    let may_be_timed = Part::ALL.into_iter().filter(|part| part.entry().may_take.t);
    let is_timed = may_be_timed.filter_map(after).flatten().any(|parameter| !is_array(parameter));
    let name = source.name();
    let function = format_ident!("{}", if is_driven { "driven" } else { "at_time" });
    let is_taken = source.functions().any(|own| own.sig.ident == function);
    let arguments = [is_driven, is_timed].into_iter().filter(|&asked| asked);
    let arguments: Vec<_> = arguments.map(|_| quote!(_: impl ::core::marker::Sized)).collect();
    (!arguments.is_empty() && !is_taken).then(|| {
        quote! {
            #[allow(dead_code)]
            impl #name {
                pub fn #function(&self, #(#arguments),*) -> Self { ::core::unreachable!() }
            }
        }
    })
}

/// That runs can follow σ, where there is one.
fn time_scale_stub(source: &Source, lagrangian: Option<&Signature>) -> Option<TokenStream> {
    source.functions().find(|function| function.sig.ident == "time_scale")?;
    let name = source.name();
    let (scalar, n) = shape(lagrangian?, name)?;
    let vector = quote!(::dalembert::nalgebra::SVector<#scalar, #n>);
    Some(quote! {
        const _: () = {
            impl ::dalembert::generated::TimeScale<#n> for #name {
                fn time_scale(&self, _: &#vector) -> #scalar { ::core::unreachable!() }
                fn time_scale_gradient(&self, _: &#vector) -> (#scalar, #vector) { ::core::unreachable!() }
            }
        };
    })
}

/// Stubs of the one trait that the function's result names.
fn field_stubs(source: &Source) -> Option<TokenStream> {
    let Source::Function(function) = source else { return None };
    let (name, signature) = (&function.name, &function.item.sig);
    let (scalar, n) = shape(signature, name)?;
    let vector = quote!(::dalembert::nalgebra::SVector<#scalar, #n>);
    let matrix = quote!(::dalembert::nalgebra::SMatrix<#scalar, #n, #n>);
    Some(match &signature.output {
        ReturnType::Type(_, ty) if matches!(**ty, Type::Array(_)) => quote! {
            const _: () = {
                impl ::dalembert::generated::VectorField<#n> for #name {
                    type Scalar = #scalar;
                    fn vector(&self, _: &#vector) -> #vector { ::core::unreachable!() }
                    fn jacobian(&self, _: &#vector) -> #matrix { ::core::unreachable!() }
                }
            };
        },
        _ => quote! {
            const _: () = {
                impl ::dalembert::generated::ScalarField<#n> for #name {
                    type Scalar = #scalar;
                    fn value(&self, _: &#vector) -> #scalar { ::core::unreachable!() }
                    fn gradient(&self, _: &#vector) -> #vector { ::core::unreachable!() }
                    fn hessian(&self, _: &#vector) -> #matrix { ::core::unreachable!() }
                }
            };
        },
    })
}

fn stubs_of(
    lagrangian: Option<&Signature>,
    name: &syn::Ident,
    rules: &Rules,
    lanes: &Lanes,
) -> Option<TokenStream> {
    let (scalar, n) = shape(lagrangian?, name)?;
    Some(stubs(name, &scalar, &n, rules, lanes))
}

/// Scalar and N, from the first array among the parameters.
fn shape(signature: &Signature, system: &syn::Ident) -> Option<(TokenStream, TokenStream)> {
    signature.inputs.iter().find_map(|parameter| match parameter {
        FnArg::Typed(parameter) => match &*parameter.ty {
            Type::Array(array) => {
                let scalar = simple_name(&array.elem)?;
                if scalar != "f64" && scalar != "f32" {
                    return None;
                }
                let degrees = Degrees { length: array.len.clone(), system: system.clone() };
                Some((quote!(#scalar), degrees.times(1)))
            }
            _ => None,
        },
        FnArg::Receiver(_) => None,
    })
}

/// Implementations that no program will run: the diagnostics stop the compilation.
///
/// Only for the rules listed, since with others beside them `system.step(…)` would be ambiguous; for all
/// where the list is what is wrong.
fn stubs(
    name: &syn::Ident,
    scalar: &TokenStream,
    n: &TokenStream,
    rules: &Rules,
    lanes: &Lanes,
) -> TokenStream {
    let vector = quote!(&::dalembert::nalgebra::SVector<#scalar, #n>);
    let derivatives = quote!(::dalembert::generated::Derivatives<#scalar, #n>);
    let is_empty = rules.of_displacement.is_empty() && !rules.gauss;
    let forced = (is_empty || rules.gauss || lanes.gauss.is_some()).then(|| {
        quote! {
            impl ::dalembert::generated::ForcedLagrangian<#n> for #name {
                type Anchors<const S: usize> = ();
            }
        }
    });
    let rules = if is_empty { &[Rule::Midpoint, Rule::Trapezoidal] } else { &rules.of_displacement[..] };
    // That the system offers methods: with which rule does not matter.
    let offered = rules.iter().find(|rule| rule.entry().is_self_adjoint).map(|rule| {
        let rule = rule.ident();
        quote! {
            impl ::dalembert::generated::OffersMethods<#n> for #name {
                type Methods = ::dalembert::generated::#rule;
            }
        }
    });
    let smooth = rules.contains(&Rule::Proximal).then(|| {
        quote!(
            impl ::dalembert::generated::SmoothRayleigh<#n> for #name {}
        )
    });
    let gathered = lanes.words().next().map(|_| {
        quote! {
            impl ::dalembert::generated::Gathered<#n> for #name {
                type Fields<'s, const W: usize> = () where Self: 's;
                fn fields<const W: usize>(_: [&Self; W]) {}
            }
        }
    });
    let forced_in_lanes = lanes.gauss.is_some().then(|| gauss_stubs(name, scalar, n));
    let midpoint_in_lanes = lanes.midpoint.is_some().then(|| midpoint_stubs(name, scalar, n));
    // The rule of the lanes, where it is what is missing.
    let is_in_lanes = lanes.explicit.is_some();
    let asked = [(Rule::Trapezoidal, is_in_lanes), (Rule::Midpoint, lanes.midpoint.is_some())];
    let missing = asked.iter().filter(|(rule, is_asked)| *is_asked && !rules.contains(rule));
    let missing = missing.map(|(rule, _)| rule);
    let rules: Vec<_> = rules.iter().chain(missing).map(|rule| rule.ident()).collect();
    let explicit =
        rules.iter().any(|rule| *rule == "Trapezoidal").then(|| explicit_stubs(name, scalar, n, is_in_lanes));
    quote! {
        const _: () = {
            impl ::dalembert::generated::Lagrangian<#n> for #name {
                type Scalar = #scalar;
                fn lagrangian(&self, _: #vector, _: #vector) -> #scalar { ::core::unreachable!() }
                fn lagrangian_derivatives(&self, _: #vector, _: #vector) -> #derivatives { ::core::unreachable!() }
            }
            impl ::dalembert::generated::Rayleigh<#n> for #name {
                fn rayleigh(&self, _: #vector, _: #vector) -> #scalar { ::core::unreachable!() }
                fn rayleigh_derivatives(&self, _: #vector, _: #vector) -> #derivatives { ::core::unreachable!() }
            }
            impl ::dalembert::generated::Force<#n> for #name {
                fn force(&self, _: #vector, _: #vector) -> ::dalembert::nalgebra::SVector<#scalar, #n> { ::core::unreachable!() }
                fn force_derivatives(&self, _: #vector, _: #vector) -> ::dalembert::generated::CovectorDerivatives<#scalar, #n> { ::core::unreachable!() }
            }
            impl ::dalembert::generated::ActingForce<#n> for #name {}
            #smooth
            #forced
            #offered
            #explicit
            #gathered
            #forced_in_lanes
            #midpoint_in_lanes
            #(
                impl ::dalembert::generated::Fused<::dalembert::generated::#rules, #n> for #name {
                    type Matrix = ::dalembert::nalgebra::SMatrix<#scalar, #n, #n>;
                    type Memory = ::dalembert::generated::VelocityHistory<#scalar, #n>;
                    type Border = ::dalembert::generated::Free;
                    fn step_kernel(&self, _: &::dalembert::generated::Segment<#scalar, #n>) -> ::dalembert::generated::StepKernel<#scalar, #n> { ::core::unreachable!() }
                    fn momenta(&self, _: &::dalembert::generated::Segment<#scalar, #n>) -> ::dalembert::generated::Momenta<#scalar, #n> { ::core::unreachable!() }
                }
            )*
        };
    }
}

/// Stubs of explicit steps, and of those in lanes.
fn explicit_stubs(
    name: &syn::Ident,
    scalar: &TokenStream,
    n: &TokenStream,
    is_in_lanes: bool,
) -> TokenStream {
    let vector = quote!(::dalembert::nalgebra::SVector<#scalar, #n>);
    let members = quote!(::dalembert::generated::MemberVector<#scalar, #n, W>);
    let in_lanes = is_in_lanes.then(|| {
        quote! {
            impl ::dalembert::generated::ExplicitInLanes<#n> for #name {
                fn velocity_momenta_in_lanes<'s, const W: usize>(_: &(), _: &#members, _: #scalar) -> [#members; 2] where Self: 's { ::core::unreachable!() }
                fn configuration_force_in_lanes<'s, const W: usize>(_: &(), _: &#members) -> #members where Self: 's { ::core::unreachable!() }
            }
        }
    });
    quote! {
        impl ::dalembert::generated::Explicit<#n> for #name {
            fn step_matrix(&self, _: #scalar) -> ::dalembert::nalgebra::SMatrix<#scalar, #n, #n> { ::core::unreachable!() }
            fn velocity_momenta(&self, _: &#vector, _: #scalar) -> ::dalembert::generated::Momenta<#scalar, #n> { ::core::unreachable!() }
            fn configuration_force(&self, _: &#vector) -> #vector { ::core::unreachable!() }
        }
        #in_lanes
    }
}

/// Stubs of midpoint steps in lanes.
fn midpoint_stubs(name: &syn::Ident, scalar: &TokenStream, n: &TokenStream) -> TokenStream {
    let members = quote!(::dalembert::generated::MemberVector<#scalar, #n, W>);
    quote! {
        impl ::dalembert::generated::DiscreteInLanes<::dalembert::generated::Midpoint, #n> for #name {
            fn step_kernel_in_lanes<'s, const W: usize>(_: &(), _: &#members, _: &#members, _: #scalar) -> (#members, [#members; #n]) where Self: 's { ::core::unreachable!() }
            fn momenta_in_lanes<'s, const W: usize>(_: &(), _: &#members, _: &#members, _: #scalar) -> [#members; 2] where Self: 's { ::core::unreachable!() }
        }
    }
}

/// Stubs of Gauss steps in lanes.
fn gauss_stubs(name: &syn::Ident, scalar: &TokenStream, n: &TokenStream) -> TokenStream {
    let members = quote!(::dalembert::generated::MemberVector<#scalar, #n, W>);
    quote! {
        impl ::dalembert::generated::ForcedLagrangianInLanes<#n> for #name {
            type Kept<const W: usize> = ();
            type AnchorsInLanes<const W: usize> = ();
            fn rates_in_lanes<'s, const W: usize>(_: &(), _: &mut (), _: &#members, _: &#members) -> (#members, ()) where Self: 's { ::core::unreachable!() }
            fn corrections_in_lanes<'s, const W: usize>(_: &(), _: &(), _: &#members, _: &#members) -> [#members; 2] where Self: 's { ::core::unreachable!() }
        }
    }
}
