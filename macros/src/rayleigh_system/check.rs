//! Signatures: what `lagrangian`, `rayleigh`, `force` or a free function must look like.

use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::{
    Expr, ExprLit, FnArg, Ident, ImplItemFn, Lit, Pat, ReceiverKind, ReturnType, Safety, Signature, Type,
};

use super::attribute::Options;
use super::diagnostics::{Mistake, Report};
use super::model::{Body, Degrees, Function, RayleighArguments, Source, System, Timed};
use super::syntax::simple_name;

/// The system as far as its signatures tell, or nothing if not even N is known; every wrong one is reported.
pub fn system<'a>(source: &'a Source, options: &Options, report: &mut Report) -> Option<System<'a>> {
    match source {
        Source::Block(_) => block(source, options, report),
        Source::Function(function) => free_function(source, function, options, report),
    }
}

/// The shape that all arrays of a system share.
struct Shape {
    scalar: Ident,
    degrees: Degrees,
}

fn block<'a>(source: &'a Source, options: &Options, report: &mut Report) -> Option<System<'a>> {
    let named = |name: &str| source.functions().find(|function| function.sig.ident == name);
    let rayleigh = named("rayleigh");
    let Some(lagrangian) = named("lagrangian") else {
        match rayleigh {
            Some(rayleigh) => report.at(&rayleigh.sig.ident, Mistake::RayleighWithoutLagrangian),
            None => report.at(source.name(), Mistake::NoLagrangian),
        }
        return None;
    };
    let before = report.count();
    let (shape, of_lagrangian) = lagrangian_signature(&lagrangian.sig, source.name(), report)?;
    let mut bodies = Vec::new();
    let mut keep = |function: &ImplItemFn, before, report: &Report| {
        bodies.push(Body { function: function.clone(), has_right_signature: report.count() == before });
    };
    keep(lagrangian, before, report);
    let (arguments, of_rayleigh) = rayleigh
        .and_then(|rayleigh| {
            let before = report.count();
            let arguments = rayleigh_signature(&rayleigh.sig, &shape, report);
            keep(rayleigh, before, report);
            arguments
        })
        .unzip();
    let force = named("force");
    let (input, of_force) = force
        .and_then(|force| {
            let before = report.count();
            let arguments = force_signature(&force.sig, &shape, report);
            keep(force, before, report);
            arguments
        })
        .unwrap_or_default();
    let timed =
        Timed { lagrangian: of_lagrangian, rayleigh: of_rayleigh.unwrap_or_default(), force: of_force };
    let generated = if input.is_some() { Some("driven") } else { timed.any().then_some("at_time") };
    if let Some(taken) = generated.and_then(named) {
        report.at(&taken.sig.ident, Mistake::GeneratedFunction(taken.sig.ident.to_string()));
    }
    Some(System {
        source,
        name: source.name().clone(),
        degrees: shape.degrees,
        scalar: shape.scalar,
        rules: options.rules.clone(),
        engine: options.engine,
        bodies,
        rayleigh: arguments,
        has_force: force.is_some(),
        input: input.map(|length| Degrees { length, system: source.name().clone() }),
        timed,
        parameters: options.parameters.clone(),
        second: options.second,
    })
}

fn free_function<'a>(
    source: &'a Source,
    function: &Function,
    options: &Options,
    report: &mut Report,
) -> Option<System<'a>> {
    let before = report.count();
    let signature = &function.item.sig;
    qualifiers(signature, report);
    let mut parameters = typed_parameters(signature, report);
    if parameters.len() < 2 || signature.receiver().is_some() {
        report.at(&signature.ident, Mistake::FunctionParameters { scalar: "f64" });
        return None;
    }
    let fields = parameters.split_off(2);
    let shape = shape_of(parameters[0].1, "q", &function.name, report)?;
    same_shape(parameters[1].1, "v", &shape, report);
    owned_parameters(&fields, report);
    let rayleigh = match result(signature) {
        Some(Type::Tuple(pair))
            if pair.elems.len() == 2 && pair.elems.iter().all(|ty| is(ty, &shape.scalar)) =>
        {
            Some(RayleighArguments::ConfigurationAndVelocity)
        }
        Some(ty) if is(ty, &shape.scalar) => None,
        _ => {
            let scalar = shape.scalar.to_string();
            report.at(&result_tokens(signature), Mistake::FunctionReturns { scalar });
            None
        }
    };
    Some(function_system(source, function, shape, options, rayleigh, report.count() == before))
}

/// What a field is: the number of its components.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Field {
    Vector,
    Scalar,
}

/// The function of a field on the configuration space.
pub fn field<'a>(source: &'a Source, report: &mut Report) -> Option<(System<'a>, Field)> {
    let Source::Function(function) = source else { return None };
    let before = report.count();
    let signature = &function.item.sig;
    qualifiers(signature, report);
    let parameters = typed_parameters(signature, report);
    let [(_, q), fields @ ..] = &parameters[..] else {
        report.at(&signature.ident, Mistake::FieldParameters);
        return None;
    };
    if signature.receiver().is_some() {
        report.at(&signature.ident, Mistake::FieldParameters);
        return None;
    }
    let shape = shape_of(q, "q", &function.name, report)?;
    owned_parameters(fields, report);
    let field = match result(signature) {
        Some(ty @ Type::Array(_)) => {
            same_shape(ty, "q", &shape, report);
            Field::Vector
        }
        Some(ty) if is(ty, &shape.scalar) => Field::Scalar,
        _ => {
            let (scalar, degrees) =
                (shape.scalar.to_string(), shape.degrees.length.to_token_stream().to_string());
            report.at(&result_tokens(signature), Mistake::FieldReturns { scalar, degrees });
            return None;
        }
    };
    let has_right_signature = report.count() == before;
    Some((function_system(source, function, shape, &Options::default(), None, has_right_signature), field))
}

/// Parameters that become fields cannot be references.
fn owned_parameters(parameters: &[(&Ident, &Type)], report: &mut Report) {
    for (_, ty) in parameters {
        if matches!(ty, Type::Reference(_)) {
            report.at(ty, Mistake::FieldByReference);
        }
    }
}

fn function_system<'a>(
    source: &'a Source,
    function: &Function,
    shape: Shape,
    options: &Options,
    rayleigh: Option<RayleighArguments>,
    has_right_signature: bool,
) -> System<'a> {
    let body = ImplItemFn {
        attrs: function.item.attrs.clone(),
        vis: syn::Visibility::Inherited,
        modifiers: Default::default(),
        sig: function.item.sig.clone(),
        block: (*function.item.block).clone(),
    };
    System {
        source,
        name: function.name.clone(),
        degrees: shape.degrees,
        scalar: shape.scalar,
        rules: options.rules.clone(),
        engine: options.engine,
        bodies: vec![Body { function: body, has_right_signature }],
        rayleigh,
        has_force: false,
        input: None,
        timed: Timed::default(),
        parameters: options.parameters.clone(),
        second: options.second,
    }
}

/// The shape of the system, and whether L takes the time.
fn lagrangian_signature(signature: &Signature, system: &Ident, report: &mut Report) -> Option<(Shape, bool)> {
    const FUNCTION: &str = "lagrangian";
    qualifiers(signature, report);
    receiver(signature, FUNCTION, report);
    let parameters = typed_parameters(signature, report);
    let [(_, q), (_, v), ref after @ ..] = parameters[..] else {
        report.at(&signature.ident, Mistake::Parameters { function: FUNCTION, expected: LAGRANGIAN });
        return None;
    };
    let shape = shape_of(q, "q", system, report);
    let Some(shape) = shape else {
        shape_of(v, "v", system, report);
        return None;
    };
    same_shape(v, "v", &shape, report);
    let is_timed = match after {
        [] => false,
        [(_, t)] => time_without_input(t, &shape, report),
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

/// Whether the parameter after the others is a time; if not, says so.
fn time(ty: &Type, shape: &Shape, report: &mut Report) -> bool {
    let is_time = is(ty, &shape.scalar);
    if !is_time {
        report.at(ty, Mistake::NotATime { scalar: shape.scalar.to_string() });
    }
    is_time
}

/// The same for L and R, which may be mistaken for what takes an input.
fn time_without_input(ty: &Type, shape: &Shape, report: &mut Report) -> bool {
    match ty {
        Type::Array(_) => {
            report.at(ty, Mistake::InputOfFunction);
            false
        }
        ty => time(ty, shape, report),
    }
}

/// The length of an input's array.
fn input(ty: &Type, shape: &Shape, report: &mut Report) -> Option<Expr> {
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

/// What R takes, and whether the time is part of it.
fn rayleigh_signature(
    signature: &Signature,
    shape: &Shape,
    report: &mut Report,
) -> Option<(RayleighArguments, bool)> {
    const FUNCTION: &str = "rayleigh";
    qualifiers(signature, report);
    receiver(signature, FUNCTION, report);
    scalar_result(signature, FUNCTION, shape, report);
    let parameters = typed_parameters(signature, report);
    let of_both = |q, v, report: &mut Report| {
        same_shape(q, "q", shape, report);
        same_shape(v, "v", shape, report);
        RayleighArguments::ConfigurationAndVelocity
    };
    match parameters[..] {
        [(_, v)] => {
            same_shape(v, "v", shape, report);
            Some((RayleighArguments::Velocity, false))
        }
        [(_, v), (_, t)] if is(t, &shape.scalar) => {
            same_shape(v, "v", shape, report);
            Some((RayleighArguments::Velocity, true))
        }
        [(_, q), (_, v)] => Some((of_both(q, v, report), false)),
        [(_, q), (_, v), (_, t)] => {
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
fn force_signature(
    signature: &Signature,
    shape: &Shape,
    report: &mut Report,
) -> Option<(Option<Expr>, bool)> {
    const FUNCTION: &str = "force";
    qualifiers(signature, report);
    receiver(signature, FUNCTION, report);
    let parameters = typed_parameters(signature, report);
    let arguments = match parameters[..] {
        [(_, q), (_, v), ref after @ ..] if after.len() <= 2 => {
            same_shape(q, "q", shape, report);
            same_shape(v, "v", shape, report);
            Some(match after {
                [] => (None, false),
                [(_, t)] if is(t, &shape.scalar) => (None, true),
                [(_, u)] => (input(u, shape, report), false),
                [(_, t), (_, Type::Array(_))] if is(t, &shape.scalar) => {
                    report.at(t, Mistake::NotAnInput { scalar: shape.scalar.to_string() });
                    (None, true)
                }
                [(_, u), rest @ ..] => {
                    (input(u, shape, report), rest.iter().all(|(_, t)| time(t, shape, report)))
                }
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

/// Whether a length is the literal 0.
fn is_zero(length: &Expr) -> bool {
    matches!(length, Expr::Lit(ExprLit { lit: Lit::Int(n), .. }) if n.base10_digits() == "0")
}

/// What no differentiated function can be.
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

/// Patterns and types of the parameters after the receiver.
fn typed_parameters<'s>(signature: &'s Signature, report: &mut Report) -> Vec<(&'s Ident, &'s Type)> {
    let mut parameters = Vec::new();
    for parameter in &signature.inputs {
        if let FnArg::Typed(parameter) = parameter {
            match &*parameter.pat {
                Pat::Ident(pattern) if pattern.subpat.is_none() && pattern.by_ref.is_none() => {
                    parameters.push((&pattern.ident, &*parameter.ty));
                }
                Pat::Wild(_) => parameters.push((&signature.ident, &*parameter.ty)),
                pattern => {
                    report.at(pattern, Mistake::ParameterPattern);
                    parameters.push((&signature.ident, &*parameter.ty));
                }
            }
        }
    }
    parameters
}

fn shape_of(ty: &Type, name: &'static str, system: &Ident, report: &mut Report) -> Option<Shape> {
    let Type::Array(array) = ty else {
        report.at(ty, Mistake::NotAnArray(name));
        return None;
    };
    let scalar = match simple_name(&array.elem) {
        Some(scalar) if scalar == "f64" || scalar == "f32" => scalar.clone(),
        _ => {
            report.at(&array.elem, Mistake::NotAScalar);
            return None;
        }
    };
    if is_zero(&array.len) {
        report.at(&array.len, Mistake::ZeroDegrees);
        return None;
    }
    Some(Shape { scalar, degrees: Degrees { length: array.len.clone(), system: system.clone() } })
}

fn same_shape(ty: &Type, name: &'static str, shape: &Shape, report: &mut Report) {
    let Type::Array(array) = ty else {
        report.at(ty, Mistake::NotAnArray(name));
        return;
    };
    if !is(&array.elem, &shape.scalar) {
        report.at(&array.elem, Mistake::OtherScalar { expected: shape.scalar.to_string() });
    }
    let expected = shape.degrees.length.to_token_stream().to_string();
    if array.len.to_token_stream().to_string() != expected {
        report.at(&array.len, Mistake::OtherDegrees { expected });
    }
}

fn scalar_result(signature: &Signature, function: &'static str, shape: &Shape, report: &mut Report) {
    if !result(signature).is_some_and(|ty| is(ty, &shape.scalar)) {
        let expected = format!("`{}`", shape.scalar);
        report.at(&result_tokens(signature), Mistake::Returns { function, expected });
    }
}

fn is(ty: &Type, scalar: &Ident) -> bool {
    simple_name(ty) == Some(scalar)
}

fn result(signature: &Signature) -> Option<&Type> {
    match &signature.output {
        ReturnType::Default => None,
        ReturnType::Type(_, ty) => Some(ty),
    }
}

/// Where to point for a wrong result: at its type, or at the name if there is none.
fn result_tokens(signature: &Signature) -> TokenStream {
    match &signature.output {
        ReturnType::Default => signature.ident.to_token_stream(),
        ReturnType::Type(_, ty) => ty.to_token_stream(),
    }
}
