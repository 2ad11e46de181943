//! The view of a system with its input held and its time set: what a step of such a system is taken of.
//!
//! The comment above each quotation shows what it expands to.

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::{Expr, Meta, MetaNameValue};

use super::super::model::{Home, Source, System};
use super::super::parts::Part;
use super::super::syntax::with_words;
use super::item::conditions;

/// `DrivenArm` if the force takes an input, else `ArmAtTime`.
pub fn name(system: &System<'_>) -> Ident {
    let name = &system.name;
    if system.input.is_some() { format_ident!("Driven{name}") } else { format_ident!("{name}AtTime") }
}

/// The type that the traits are implemented for: `Arm`, `DrivenArm<'_>`.
pub fn subject(system: &System<'_>, home: Home) -> TokenStream {
    match home {
        Home::System => {
            let name = &system.name;
            quote!(#name)
        }
        Home::View => {
            let view = name(system);
            quote!(#view<'_>)
        }
    }
}

/// The user's value from there: `self`, `self.system`.
pub fn owner(home: Home) -> TokenStream {
    match home {
        Home::System => quote!(self),
        Home::View => quote!(self.system),
    }
}

/// The arguments of a part: the vectors q and v as arrays, `self.u`, `self.t`.
fn arguments(system: &System<'_>, part: Part) -> impl Iterator<Item = TokenStream> {
    let all = [quote!((*q).into()), quote!((*v).into()), quote!(self.u), quote!(self.t)];
    system.takes(part).unwrap_or_default().choose(all)
}

/// The plain value of a part at the vectors q and v.
pub fn value(system: &System<'_>, part: Part) -> TokenStream {
    match system.source {
        Source::Block(_) => {
            let function = format_ident!("{}", part.name());
            let (owner, arguments) = (owner(system.home_of(part)), arguments(system, part));
            quote!(#owner.#function(#(#arguments),*))
        }
        Source::Function(source) => {
            let name = &source.item.sig.ident;
            let fields = source.fields().map(|(field, _)| quote!(self.#field));
            let index = system
                .has(Part::Rayleigh)
                .then(|| if part == Part::Lagrangian { quote!(.0) } else { quote!(.1) });
            quote!(#name((*q).into(), (*v).into(), #(#fields),*) #index)
        }
    }
}

/// Tokens of the user's functions, `self.k` and `Self::K`, as seen from the view.
pub fn seen_from_view(tokens: TokenStream, system: &Ident) -> TokenStream {
    with_words(tokens, &|word| match word {
        word if word == "self" => Some(quote!(#word.system)),
        word if word == "Self" => {
            let mut name = system.clone();
            name.set_span(word.span());
            Some(quote!(#name))
        }
        _ => None,
    })
}

/// The view's type and the function that makes it.
pub fn definition(system: &System<'_>) -> Option<TokenStream> {
    if !system.has_view() {
        return None;
    }
    let System { name: system_name, scalar, .. } = system;
    let view = name(system);
    let conditions = conditions(system.source);
    let m = system.input.as_ref().map(|input| input.times(1));
    let input = m.iter();
    let time = system.is_timed().then_some(scalar).into_iter();
    let (time_field, time_parameter, t) = (time.clone(), time.clone(), time.clone().map(|_| quote!(t)));
    let fields = quote!(#(u: [#scalar; #input],)* #(t: #time_field),*);
    let (function, text, about) = match (&m, system.is_timed()) {
        (Some(_), false) => {
            ("driven", " The system with the input `u` held over the step.", "its input held over a step")
        }
        (Some(_), true) => (
            "driven",
            " The system with the input `u` held over the step that starts at time `t`.",
            "its input held over a step that starts at a given time",
        ),
        (None, _) => ("at_time", " The system at time `t`, where its next step starts.", "its time set"),
    };
    let function = format_ident!("{function}");
    let about = format!(" [`{system_name}`] with {about}; see [`{system_name}::{function}`].");
    let input_parameter = m.iter().map(|m| quote!(u: impl ::dalembert::generated::Input<#scalar, #m>));
    let parameters = input_parameter.chain(time_parameter.map(|scalar| quote!(t: #scalar)));
    let u = m.iter().map(|_| quote!(u: ::dalembert::generated::Input::entries(u)));
    let values = u.chain(t);
    // pub struct DrivenArm<'a> { system: &'a Arm, u: [f64; 2] }
    // pub fn driven(&self, u: impl Input<f64, 2>) -> DrivenArm<'_>
    Some(quote! {
        #(#conditions)*
        #[doc = #about]
        #[derive(Clone, Copy)]
        #[allow(dead_code)]
        pub struct #view<'a> {
            system: &'a #system_name,
            #fields
        }

        #(#conditions)*
        #[allow(dead_code)]
        impl #system_name {
            #[doc = #text]
            #[inline]
            #[must_use]
            pub fn #function(&self, #(#parameters),*) -> #view<'_> {
                #view { system: self, #(#values),* }
            }
        }
    })
}

/// The description of the system for bindings to other languages.
pub fn description(system: &System<'_>) -> TokenStream {
    let System { name: system_name, scalar, .. } = system;
    let (conditions, n) = (conditions(system.source), system.degrees.times(1));
    let words = format_ident!("described_{}", system_name);
    let has_input = system.input.is_some();
    let view = system.has_view().then(|| {
        let (view, function) =
            (name(system), format_ident!("{}", if has_input { "driven" } else { "at_time" }));
        quote!([#view #function])
    });
    let input = system.input.as_ref().map(|input| input.times(1)).map(|m| quote!(, input u #m));
    let time = system.is_timed().then(|| quote!(, time t));
    let constraints = system.is_constrained().then(|| {
        let m = system.constraint_count();
        quote!(, constraints #m)
    });
    let events = system.value_count(Part::Events).map(|k| quote!(, events #k));
    let outputs = system.value_count(Part::Outputs).map(|k| {
        let documentation = documentation(system, Part::Outputs);
        quote!(, outputs #k, [#(#documentation),*])
    });
    let parameters = (!system.parameters.is_empty()).then(|| {
        let names = parameter_names(system);
        quote!(, parameters [#(#names),*])
    });
    // described! { Arm [DrivenArm driven]: f64, 2, input u 1; described_Arm $ }
    quote! {
        #(#conditions)*
        ::dalembert::generated::described! { #system_name #view: #scalar, #n #input #time #constraints #events #outputs #parameters; #words $ }
    }
}

/// The documentation of a part, a text for each line or block of it.
fn documentation<'s>(system: &System<'s>, part: Part) -> impl Iterator<Item = &'s Expr> {
    let function = system.source.functions().find(|function| function.sig.ident == part.name());
    function.into_iter().flat_map(|function| &function.attrs).filter_map(|attribute| match &attribute.meta {
        Meta::NameValue(MetaNameValue { path, value, .. }) if path.is_ident("doc") => Some(value),
        _ => None,
    })
}

/// The listed parameters as they are named: `m`, `c[0]`.
pub fn parameter_names(system: &System<'_>) -> impl Iterator<Item = String> {
    system.parameters.iter().map(|parameter| parameter.to_token_stream().to_string().replace(' ', ""))
}

/// `fn later`, where there is a time.
pub fn later(system: &System<'_>) -> Option<TokenStream> {
    let scalar = &system.scalar;
    system.is_timed().then(|| {
        quote! {
            #[inline]
            fn later<T>(&self, elapsed: #scalar, evaluate: impl FnOnce(&Self) -> T) -> T {
                evaluate(&Self { t: self.t + elapsed, ..*self })
            }
        }
    })
}

/// `impl Lagrangian<2> for DrivenArm<'_>`, or Rayleigh: that of the system itself, where it stands there.
/// `verification` is the view's own: it has more functions than the system.
pub fn delegation(system: &System<'_>, part: Part, verification: Option<TokenStream>) -> Option<TokenStream> {
    if !system.has_view() || system.home_of(part) == Home::View {
        return None;
    }
    let scalar = &system.scalar;
    let n = system.degrees.times(1);
    let view = subject(system, Home::View);
    let (function, of, associated, later) = match part {
        Part::Lagrangian => {
            let name = &system.name;
            let associated = quote! {
                type Scalar = #scalar;

                const STRUCTURE: ::dalembert::generated::Structure = <#name as Lagrangian<#n>>::STRUCTURE;
            };
            ("lagrangian", "Lagrangian", Some(associated), later(system))
        }
        Part::Rayleigh => ("rayleigh", "Rayleigh", None, None),
        Part::Force
        | Part::TimeScale
        | Part::Constraints
        | Part::VelocityConstraints
        | Part::Events
        | Part::Outputs => return None,
    };
    let [value, gradient, derivatives, variations] =
        ["", "_gradient", "_derivatives", "_variations"].map(|suffix| format_ident!("{function}{suffix}"));
    let of = format_ident!("{of}");
    Some(quote! {
        #[automatically_derived]
        impl #of<#n> for #view {
            #associated

            #[inline]
            fn #value(&self, q: &Vector, v: &Vector) -> #scalar {
                #of::#value(self.system, q, v)
            }

            #[inline]
            fn #gradient(&self, q: &Vector, v: &Vector) -> Gradient<#scalar, #n> {
                #of::#gradient(self.system, q, v)
            }

            #[inline]
            fn #derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<#scalar, #n> {
                #of::#derivatives(self.system, q, v)
            }

            #[inline]
            fn #variations(
                &self,
                q: &Vector,
                v: &Vector,
                minus: Direction<#scalar>,
                plus: Direction<#scalar>,
            ) -> Variations<#scalar, #n> {
                #of::#variations(self.system, q, v, minus, plus)
            }

            #verification

            #later
        }
    })
}
