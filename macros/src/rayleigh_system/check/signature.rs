//! The signatures of `lagrangian`, `rayleigh`, `force` and `time_scale`.

use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::{Expr, FnArg, Ident, Pat, ReceiverKind, ReturnType, Safety, Signature, Type};

use super::super::diagnostics::{Mistake, Report};
use super::super::model::RayleighArguments;
use super::place::{Parameter, Place, at_place, known_place};
use super::shape::{Shape, has_shape, is, is_zero, same_shape, shape_of};

/// The shape of the system, and whether L takes the time.
pub fn lagrangian_signature(
    signature: &Signature,
    system: &Ident,
    report: &mut Report,
) -> Option<(Shape, bool)> {
    const FUNCTION: &str = "lagrangian";
    qualifiers(signature, report);
    receiver(signature, FUNCTION, report);
    let parameters = typed_parameters(signature, report);
    let [(of_q, q), (of_v, v), ref after @ ..] = parameters[..] else {
        report.at(&signature.ident, Mistake::Parameters { function: FUNCTION, expected: LAGRANGIAN });
        return None;
    };
    at_place(of_q, Place::Configuration, report);
    at_place(of_v, Place::Velocity, report);
    let shape = shape_of(q, "q", system, report);
    let Some(shape) = shape else {
        shape_of(v, "v", system, report);
        return None;
    };
    same_shape(v, "v", &shape, report);
    let is_timed = match after {
        [] => false,
        [t] => time_without_input(*t, &shape, report),
        _ => {
            report.at(&signature.ident, Mistake::Parameters { function: FUNCTION, expected: LAGRANGIAN });
            false
        }
    };
    scalar_result(signature, FUNCTION, &shape, report);
    Some((shape, is_timed))
}

const LAGRANGIAN: &str = "`(&self, q: [f64; N], v: [f64; N])`, and `t: f64` after them if it depends on time";

const RAYLEIGH: &str = "`(&self, v: [f64; N])` or `(&self, q: [f64; N], v: [f64; N])`, and `t: f64` after them if it depends on time";
const FORCE: &str =
    "`(&self, q: [f64; N], v: [f64; N])`, and after them an input `u: [f64; M]`, a time `t: f64` or both";
const TIME_SCALE: &str = "`(&self, q: [f64; N])` alone: steps follow the configuration";

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

/// [`time`] for L and R; an array is reported as an input, which they do not take.
fn time_without_input(parameter: Parameter<'_>, shape: &Shape, report: &mut Report) -> bool {
    match parameter.1 {
        ty @ Type::Array(_) => {
            report.at(ty, Mistake::InputOfFunction);
            false
        }
        _ => time(parameter, shape, report),
    }
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

/// The arguments of R, and whether the time is among them.
pub fn rayleigh_signature(
    signature: &Signature,
    shape: &Shape,
    report: &mut Report,
) -> Option<(RayleighArguments, bool)> {
    const FUNCTION: &str = "rayleigh";
    qualifiers(signature, report);
    receiver(signature, FUNCTION, report);
    scalar_result(signature, FUNCTION, shape, report);
    let parameters = typed_parameters(signature, report);
    let of_velocity = |(name, v): Parameter<'_>, report: &mut Report| {
        at_place(name, Place::Velocity, report);
        same_shape(v, "v", shape, report);
        RayleighArguments::Velocity
    };
    let of_both = |(of_q, q): Parameter<'_>, v, report: &mut Report| {
        at_place(of_q, Place::Configuration, report);
        same_shape(q, "q", shape, report);
        of_velocity(v, report);
        RayleighArguments::ConfigurationAndVelocity
    };
    match parameters[..] {
        [v] => Some((of_velocity(v, report), false)),
        [v, t] if is(t.1, &shape.scalar) => {
            let arguments = of_velocity(v, report);
            Some((arguments, time(t, shape, report)))
        }
        [v, (_, u)] if known_place(parameters[1]) == Some(Place::Input) => {
            report.at(u, Mistake::InputOfFunction);
            Some((of_velocity(v, report), false))
        }
        [q, v] => Some((of_both(q, v, report), false)),
        [q, v, t] => {
            let arguments = of_both(q, v, report);
            Some((arguments, time_without_input(t, shape, report)))
        }
        _ => {
            report.at(&signature.ident, Mistake::Parameters { function: FUNCTION, expected: RAYLEIGH });
            None
        }
    }
}

/// The length of the input, if f takes one, and whether it takes the time.
pub fn force_signature(
    signature: &Signature,
    shape: &Shape,
    report: &mut Report,
) -> Option<(Option<Expr>, bool)> {
    const FUNCTION: &str = "force";
    qualifiers(signature, report);
    receiver(signature, FUNCTION, report);
    let parameters = typed_parameters(signature, report);
    let arguments = match parameters[..] {
        [q, v, ref after @ ..] if after.len() <= 2 && !lacks_point(q, v, shape) => {
            let ((of_q, q), (of_v, v)) = (q, v);
            at_place(of_q, Place::Configuration, report);
            at_place(of_v, Place::Velocity, report);
            same_shape(q, "q", shape, report);
            same_shape(v, "v", shape, report);
            Some(match *after {
                [] => (None, false),
                [t] if is(t.1, &shape.scalar) => (None, time(t, shape, report)),
                [u] => (input(u, shape, report), false),
                [(_, t), (_, Type::Array(_))] if is(t, &shape.scalar) => {
                    report.at(t, Mistake::NotAnInput { scalar: shape.scalar.to_string() });
                    (None, true)
                }
                [u, ref rest @ ..] => (input(u, shape, report), rest.iter().all(|t| time(*t, shape, report))),
            })
        }
        _ => {
            report.at(&signature.ident, Mistake::Parameters { function: FUNCTION, expected: FORCE });
            None
        }
    };
    match result(signature) {
        Some(ty @ Type::Array(_)) => same_shape(ty, "force", shape, report),
        _ => {
            let expected = format!("`[{}; N]`, a covector at q", shape.scalar);
            report.at(&result_tokens(signature), Mistake::Returns { function: FUNCTION, expected });
        }
    }
    arguments
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

/// Says what is wrong with the signature of σ, if anything.
pub fn time_scale_signature(signature: &Signature, shape: &Shape, report: &mut Report) {
    const FUNCTION: &str = "time_scale";
    qualifiers(signature, report);
    receiver(signature, FUNCTION, report);
    match typed_parameters(signature, report)[..] {
        [(name, q)] => {
            at_place(name, Place::Configuration, report);
            same_shape(q, "q", shape, report);
        }
        _ => report.at(&signature.ident, Mistake::Parameters { function: FUNCTION, expected: TIME_SCALE }),
    }
    scalar_result(signature, FUNCTION, shape, report);
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

fn receiver(signature: &Signature, function: &'static str, report: &mut Report) {
    match signature.receiver() {
        Some(receiver) if matches!(receiver.kind, ReceiverKind::Reference(_, _, None)) => {}
        Some(receiver) => report.at(receiver, Mistake::Receiver(function)),
        None => report.at(&signature.ident, Mistake::Receiver(function)),
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

fn scalar_result(signature: &Signature, function: &'static str, shape: &Shape, report: &mut Report) {
    if !result(signature).is_some_and(|ty| is(ty, &shape.scalar)) {
        let expected = format!("`{}`", shape.scalar);
        report.at(&result_tokens(signature), Mistake::Returns { function, expected });
    }
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
