//! The signatures of the functions that the attribute knows.

use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::{Expr, FnArg, Ident, Pat, ReceiverKind, ReturnType, Safety, Signature, Type};

use super::super::diagnostics::{Mistake, Report};
use super::super::parts::{Arguments, Entry, Part, Returns};
use super::place::{Parameter, Place, at_place, known_place};
use super::shape::{Shape, has_shape, is, is_zero, same_shape, shape_of};

/// The shape of a system, by the first array of L.
///
/// Where it tells none, what is wrong with L is reported.
pub fn shape(lagrangian: &Signature, system: &Ident, report: &mut Report) -> Option<Shape> {
    let parameters = typed_parameters(lagrangian, &mut Report::default());
    let q = parameters.first().filter(|_| parameters.len() > 1);
    let shape = q.and_then(|(_, q)| shape_of(q, "q", system, &mut Report::default()));
    if shape.is_none() {
        let parameters = qualified(lagrangian, Part::Lagrangian, report);
        match parameters[..] {
            [(of_q, q), (of_v, v), ..] => {
                at_place(of_q, Place::Configuration, report);
                at_place(of_v, Place::Velocity, report);
                shape_of(q, "q", system, report);
                shape_of(v, "v", system, report);
            }
            _ => other_parameters(lagrangian, Part::Lagrangian, report),
        }
    }
    shape
}

/// The arguments that a function takes, and lengths of arrays that it alone knows.
pub struct Stated {
    pub takes: Arguments,
    /// The length of its input, if it takes one.
    pub input: Option<Expr>,
    /// The length of its result, if that is [`Returns::Numbers`].
    pub result: Option<Expr>,
}

/// The arguments and lengths that the signature states.
///
/// All that is wrong with it is reported.
pub fn stated(signature: &Signature, part: Part, shape: &Shape, report: &mut Report) -> Stated {
    let parameters = qualified(signature, part, report);
    let entry = part.entry();
    let (mut takes, may_take) = (entry.takes, entry.may_take);
    let takes_both = (takes.q && takes.v) || (may_take.q && may_take.v && begins_by_both(&parameters, shape));
    let mut input = None;
    match (takes_both, &parameters[..]) {
        (true, &[q, v, ref after @ ..])
            if may_take.has_after(after.len()) && !(may_take.u && lacks_point(q, v, shape)) =>
        {
            (takes.q, takes.v) = (true, true);
            at_place(q.0, Place::Configuration, report);
            at_place(v.0, Place::Velocity, report);
            same_shape(q.1, "q", shape, report);
            same_shape(v.1, "v", shape, report);
            (input, takes.t) = after_point(after, may_take, shape, report);
        }
        (false, &[(of_point, point), ref after @ ..])
            if may_take.has_after(after.len()) && (may_take.v || !begins_by_array(after)) =>
        {
            let (name, place) = if takes.v { ("v", Place::Velocity) } else { ("q", Place::Configuration) };
            at_place(of_point, place, report);
            same_shape(point, name, shape, report);
            (input, takes.t) = after_point(after, may_take, shape, report);
        }
        _ => other_parameters(signature, part, report),
    }
    takes.u = input.is_some();
    let result = returned(signature, part, shape, report);
    Stated { takes, input, result }
}

fn begins_by_array(parameters: &[Parameter<'_>]) -> bool {
    matches!(parameters.first(), Some((_, Type::Array(_))))
}

/// Whether q and v are the first two, where q may be left out.
fn begins_by_both(parameters: &[Parameter<'_>], shape: &Shape) -> bool {
    let second = parameters.get(1);
    second.is_some_and(|&second| !is(second.1, &shape.scalar) && known_place(second) != Some(Place::Input))
}

/// The length of the input, if one is taken, and whether the time is: of the parameters after q and v.
fn after_point(
    after: &[Parameter<'_>],
    may_take: Arguments,
    shape: &Shape,
    report: &mut Report,
) -> (Option<Expr>, bool) {
    match *after {
        [] => (None, false),
        [(_, ty @ Type::Array(_))] if !may_take.u => {
            report.at(ty, Mistake::InputOfFunction);
            (None, false)
        }
        [t] if !may_take.u || is(t.1, &shape.scalar) => (None, time(t, shape, report)),
        [u] => (input(u, shape, report), false),
        [(_, t), (_, Type::Array(_)), ..] if is(t, &shape.scalar) => {
            report.at(t, Mistake::NotAnInput { scalar: shape.scalar.to_string() });
            (None, true)
        }
        [u, ref rest @ ..] => (input(u, shape, report), rest.iter().all(|t| time(*t, shape, report))),
    }
}

/// Whether the parameter after the others is a time; if not, says so.
fn time((name, ty): Parameter<'_>, shape: &Shape, report: &mut Report) -> bool {
    let is_time = is(ty, &shape.scalar);
    if is_time {
        at_place(name, Place::Time, report);
    } else {
        report.at(ty, Mistake::NotATime { scalar: shape.scalar.to_string() });
    }
    is_time
}

/// The length of an input's array.
fn input((name, ty): Parameter<'_>, shape: &Shape, report: &mut Report) -> Option<Expr> {
    at_place(name, Place::Input, report);
    let Type::Array(array) = ty else {
        report.at(ty, Mistake::NotAnInput { scalar: shape.scalar.to_string() });
        return None;
    };
    if !is(&array.elem, &shape.scalar) {
        report.at(&array.elem, Mistake::OtherScalar { expected: shape.scalar.to_string() });
    }
    if is_zero(&array.len) {
        report.at(&array.len, Mistake::NoInputs);
    }
    Some(array.len.clone())
}

/// Whether q or v was left out before an input or a time: the names say so, or the length of the second.
fn lacks_point(first: Parameter<'_>, second: Parameter<'_>, shape: &Shape) -> bool {
    match [known_place(first), known_place(second)] {
        [_, Some(Place::Input | Place::Time)] => true,
        [Some(Place::Velocity), place] => place != Some(Place::Configuration),
        [_, None] => !has_shape(second.1, shape),
        _ => false,
    }
}

/// The parameters, where what stands before them is reported.
fn qualified<'s>(signature: &'s Signature, part: Part, report: &mut Report) -> Vec<Parameter<'s>> {
    qualifiers(signature, report);
    match signature.receiver() {
        Some(receiver) if matches!(receiver.kind, ReceiverKind::Reference(_, _, None)) => {}
        Some(receiver) => report.at(receiver, Mistake::Receiver(part.name())),
        None => report.at(&signature.ident, Mistake::Receiver(part.name())),
    }
    typed_parameters(signature, report)
}

fn other_parameters(signature: &Signature, part: Part, report: &mut Report) {
    let Entry { name: function, parameters: expected, .. } = part.entry();
    report.at(&signature.ident, Mistake::Parameters { function, expected });
}

/// The length of the result, where the function alone knows it; a result of another type is reported.
fn returned(signature: &Signature, part: Part, shape: &Shape, report: &mut Report) -> Option<Expr> {
    let Entry { name: function, returns, .. } = part.entry();
    let expected = match (returns, result(signature)) {
        (Returns::Covector, Some(ty @ Type::Array(_))) => {
            same_shape(ty, function, shape, report);
            return None;
        }
        (Returns::Number, Some(ty)) if is(ty, &shape.scalar) => return None,
        (Returns::Numbers, Some(Type::Array(array))) => {
            if !is(&array.elem, &shape.scalar) {
                report.at(&array.elem, Mistake::OtherScalar { expected: shape.scalar.to_string() });
            }
            return Some(array.len.clone());
        }
        (Returns::Covector, _) => format!("`[{}; N]`, a covector at q", shape.scalar),
        (Returns::Numbers, _) => {
            let count = if Part::VALUES.contains(&part) { "K" } else { "M" };
            format!("`[{}; {count}]`, an array of {count} numbers", shape.scalar)
        }
        (Returns::Number, _) => format!("`{}`", shape.scalar),
    };
    report.at(&result_tokens(signature), Mistake::Returns { function, expected });
    None
}

/// Reports qualifiers and generics that no differentiated function can have.
pub fn qualifiers(signature: &Signature, report: &mut Report) {
    if let Some(word) = &signature.constness {
        report.at(word, Mistake::Qualifier("const"));
    }
    if let Some(word) = &signature.asyncness {
        report.at(word, Mistake::Qualifier("async"));
    }
    if let Safety::Unsafe(word) = &signature.safety {
        report.at(word, Mistake::Qualifier("unsafe"));
    }
    if let Some(abi) = &signature.abi {
        report.at(abi, Mistake::Qualifier("extern"));
    }
    if !signature.generics.params.is_empty() {
        report.at(&signature.generics, Mistake::GenericHelper);
    }
}

/// The parameters after the receiver.
pub fn typed_parameters<'s>(signature: &'s Signature, report: &mut Report) -> Vec<Parameter<'s>> {
    let mut parameters = Vec::new();
    for parameter in &signature.inputs {
        if let FnArg::Typed(parameter) = parameter {
            match &*parameter.pat {
                Pat::Ident(pattern) if pattern.subpat.is_none() && pattern.by_ref.is_none() => {
                    parameters.push((Some(&pattern.ident), &*parameter.ty));
                }
                Pat::Wild(_) => parameters.push((None, &*parameter.ty)),
                pattern => {
                    report.at(pattern, Mistake::ParameterPattern);
                    parameters.push((None, &*parameter.ty));
                }
            }
        }
    }
    parameters
}

pub fn result(signature: &Signature) -> Option<&Type> {
    match &signature.output {
        ReturnType::Default => None,
        ReturnType::Type(_, ty) => Some(ty),
    }
}

/// Where to point for a wrong result: at its type, or at the name if there is none.
pub fn result_tokens(signature: &Signature) -> TokenStream {
    match &signature.output {
        ReturnType::Default => signature.ident.to_token_stream(),
        ReturnType::Type(_, ty) => ty.to_token_stream(),
    }
}
