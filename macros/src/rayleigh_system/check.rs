//! Signatures: what `lagrangian`, `rayleigh`, `force` or a free function must look like.

use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::{
    Expr, ExprLit, FnArg, Ident, ImplItemFn, Lit, Pat, ReceiverKind, ReturnType, Safety, Signature, Type,
};

use super::diagnostics::{Mistake, Report};
use super::model::{Body, Degrees, Function, RayleighArguments, Rule, Source, System, simple_name};

/// The system as far as its signatures tell, or nothing if not even N is known; every wrong one is reported.
pub fn system<'a>(source: &'a Source, rules: Vec<Rule>, report: &mut Report) -> Option<System<'a>> {
    match source {
        Source::Block(_) => block(source, rules, report),
        Source::Function(function) => free_function(source, function, rules, report),
    }
}

/// The shape that all arrays of a system share.
struct Shape {
    scalar: Ident,
    degrees: Degrees,
}

fn block<'a>(source: &'a Source, rules: Vec<Rule>, report: &mut Report) -> Option<System<'a>> {
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
    let shape = lagrangian_signature(&lagrangian.sig, source.name(), report)?;
    let mut bodies = Vec::new();
    let mut keep = |function: &ImplItemFn, before, report: &Report| {
        bodies.push(Body { function: function.clone(), has_right_signature: report.count() == before });
    };
    keep(lagrangian, before, report);
    let arguments = rayleigh.and_then(|rayleigh| {
        let before = report.count();
        let arguments = rayleigh_signature(&rayleigh.sig, &shape, report);
        keep(rayleigh, before, report);
        arguments
    });
    let force = named("force");
    if let Some(force) = force {
        let before = report.count();
        force_signature(&force.sig, &shape, report);
        keep(force, before, report);
    }
    Some(System {
        source,
        name: source.name().clone(),
        degrees: shape.degrees,
        scalar: shape.scalar,
        rules,
        bodies,
        rayleigh: arguments,
        has_force: force.is_some(),
    })
}

fn free_function<'a>(
    source: &'a Source,
    function: &Function,
    rules: Vec<Rule>,
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
    Some(function_system(source, function, shape, rules, rayleigh, report.count() == before))
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
    Some((function_system(source, function, shape, Vec::new(), None, has_right_signature), field))
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
    rules: Vec<Rule>,
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
        rules,
        bodies: vec![Body { function: body, has_right_signature }],
        rayleigh,
        has_force: false,
    }
}

fn lagrangian_signature(signature: &Signature, system: &Ident, report: &mut Report) -> Option<Shape> {
    const FUNCTION: &str = "lagrangian";
    qualifiers(signature, report);
    receiver(signature, FUNCTION, report);
    let parameters = typed_parameters(signature, report);
    let [(_, q), (_, v)] = parameters[..] else {
        report.at(
            &signature.ident,
            Mistake::Parameters { function: FUNCTION, expected: "`(&self, q: [f64; N], v: [f64; N])`" },
        );
        return None;
    };
    let shape = shape_of(q, "q", system, report);
    let Some(shape) = shape else {
        shape_of(v, "v", system, report);
        return None;
    };
    same_shape(v, "v", &shape, report);
    scalar_result(signature, FUNCTION, &shape, report);
    Some(shape)
}

fn rayleigh_signature(
    signature: &Signature,
    shape: &Shape,
    report: &mut Report,
) -> Option<RayleighArguments> {
    const FUNCTION: &str = "rayleigh";
    qualifiers(signature, report);
    receiver(signature, FUNCTION, report);
    scalar_result(signature, FUNCTION, shape, report);
    match typed_parameters(signature, report)[..] {
        [(_, v)] => {
            same_shape(v, "v", shape, report);
            Some(RayleighArguments::Velocity)
        }
        [(_, q), (_, v)] => {
            same_shape(q, "q", shape, report);
            same_shape(v, "v", shape, report);
            Some(RayleighArguments::ConfigurationAndVelocity)
        }
        _ => {
            let expected = "`(&self, v: [f64; N])` or `(&self, q: [f64; N], v: [f64; N])`";
            report.at(&signature.ident, Mistake::Parameters { function: FUNCTION, expected });
            None
        }
    }
}

fn force_signature(signature: &Signature, shape: &Shape, report: &mut Report) {
    const FUNCTION: &str = "force";
    qualifiers(signature, report);
    receiver(signature, FUNCTION, report);
    match typed_parameters(signature, report)[..] {
        [(_, q), (_, v)] => {
            same_shape(q, "q", shape, report);
            same_shape(v, "v", shape, report);
        }
        _ => {
            let expected = "`(&self, q: [f64; N], v: [f64; N])`";
            report.at(&signature.ident, Mistake::Parameters { function: FUNCTION, expected });
        }
    }
    match result(signature) {
        Some(ty @ Type::Array(_)) => same_shape(ty, "force", shape, report),
        _ => {
            let expected = format!("`[{}; N]`, a covector at q", shape.scalar);
            report.at(&result_tokens(signature), Mistake::Returns { function: FUNCTION, expected });
        }
    }
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
    if matches!(&array.len, Expr::Lit(ExprLit { lit: Lit::Int(n), .. }) if n.base10_digits() == "0") {
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
