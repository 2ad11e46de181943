//! From the annotated item to the system that its signatures state.

mod place;
mod shape;
mod signature;

use quote::ToTokens;
use syn::{Expr, Ident, ImplItemFn, Signature, Type};

use super::attribute::Options;
use super::diagnostics::{Mistake, Report};
use super::model::{Body, Degrees, Function, Source, System};
use super::parts::{Arguments, Part};
use place::{Parameter, Place, at_field, at_place};
use shape::{Shape, is, same_shape, shape_of};
pub use signature::qualifiers;
use signature::{result, result_tokens, typed_parameters};

/// The system as far as its signatures tell, or nothing if not even N is known; every wrong one is reported.
pub fn system<'a>(source: &'a Source, options: &Options, report: &mut Report) -> Option<System<'a>> {
    match source {
        Source::Block(_) => block(source, options, report),
        Source::Function(function) => free_function(source, function, options, report),
    }
}

fn block<'a>(source: &'a Source, options: &Options, report: &mut Report) -> Option<System<'a>> {
    let named = |name: &str| source.functions().find(|function| function.sig.ident == name);
    let Some(lagrangian) = named(Part::Lagrangian.name()) else {
        match named(Part::Rayleigh.name()) {
            Some(rayleigh) => report.at(&rayleigh.sig.ident, Mistake::RayleighWithoutLagrangian),
            None => report.at(source.name(), Mistake::NoLagrangian),
        }
        return None;
    };
    let shape = signature::shape(&lagrangian.sig, source.name(), report)?;
    let (mut bodies, mut takes) = (Vec::new(), [None; Part::ALL.len()]);
    let (mut input, mut constraints, mut values) = (None, [None, None], [const { None }; Part::VALUES.len()]);
    for (part, takes) in Part::ALL.into_iter().zip(&mut takes) {
        let Some(function) = named(part.name()) else { continue };
        let before = report.count();
        let stated = signature::stated(&function.sig, part, &shape, report);
        *takes = Some(stated.takes);
        if part == Part::Force {
            input = stated.input;
        } else if let Some(length) = &stated.input
            && bodies.iter().all(|body: &Body| body.has_right_signature)
        {
            same_input(&function.sig, length, input.as_ref(), report);
        }
        if let Some(kind) = Part::CONSTRAINTS.iter().position(|&of| of == part) {
            constraints[kind] = stated.result;
        } else if let Some(kind) = Part::VALUES.iter().position(|&of| of == part) {
            values[kind] = stated.result;
        }
        let has_right_signature = report.count() == before;
        if part.entry().is_differentiated {
            bodies.push(Body { function: function.clone(), has_right_signature });
        }
    }
    let degrees = |length| Degrees { length, system: source.name().clone() };
    let system = System {
        input: input.map(degrees),
        constraints: constraints.map(|length| length.map(degrees)),
        values: values.map(|length| length.map(degrees)),
        ..of_shape(source, source.name(), shape, options, (takes, bodies))
    };
    let generated =
        if system.input.is_some() { Some("driven") } else { system.is_timed().then_some("at_time") };
    if let Some(taken) = generated.and_then(named) {
        report.at(&taken.sig.ident, Mistake::GeneratedFunction(taken.sig.ident.to_string()));
    }
    Some(system)
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
    for ((name, _), place) in parameters.iter().zip([Place::Configuration, Place::Velocity]) {
        at_place(*name, place, report);
    }
    for field in &fields {
        at_field(*field, report);
    }
    let shape = shape_of(parameters[0].1, "q", &function.name, report)?;
    same_shape(parameters[1].1, "v", &shape, report);
    owned_parameters(&fields, report);
    let is_scalar = |ty: &Type| is(ty, &shape.scalar);
    let has_rayleigh = match result(signature) {
        Some(Type::Tuple(pair)) if pair.elems.len() == 2 && pair.elems.iter().all(is_scalar) => true,
        Some(ty) if is_scalar(ty) => false,
        _ => {
            let scalar = shape.scalar.to_string();
            report.at(&result_tokens(signature), Mistake::FunctionReturns { scalar });
            false
        }
    };
    Some(function_system(source, function, shape, options, has_rayleigh, report.count() == before))
}

/// The kind of a field, by the number of its components.
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
    let [(of_q, q), fields @ ..] = &parameters[..] else {
        report.at(&signature.ident, Mistake::FieldParameters);
        return None;
    };
    at_place(*of_q, Place::Configuration, report);
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
    Some((function_system(source, function, shape, &Options::default(), false, has_right_signature), field))
}

/// Reports an input, the third parameter, that is not the one that acts through the force.
fn same_input(of: &Signature, length: &Expr, of_force: Option<&Expr>, report: &mut Report) {
    match (of_force.map(|length| length.to_token_stream().to_string()), typed_parameters(of, report).get(2)) {
        (None, Some((_, ty))) => report.at(ty, Mistake::InputOfFunction),
        (Some(expected), _) if length.to_token_stream().to_string() != expected => {
            report.at(length, Mistake::OtherInput { expected });
        }
        _ => {}
    }
}

/// Parameters that become fields cannot be references.
fn owned_parameters(parameters: &[Parameter<'_>], report: &mut Report) {
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
    has_rayleigh: bool,
    has_right_signature: bool,
) -> System<'a> {
    let body = ImplItemFn {
        attrs: function.item.attrs.clone(),
        vis: syn::Visibility::Inherited,
        modifiers: Default::default(),
        sig: function.item.sig.clone(),
        block: (*function.item.block).clone(),
    };
    let both = Part::Lagrangian.entry().takes;
    let takes = Part::ALL.map(|part| match part {
        Part::Lagrangian => Some(both),
        Part::Rayleigh => has_rayleigh.then_some(both),
        _ => None,
    });
    let bodies = vec![Body { function: body, has_right_signature }];
    of_shape(source, &function.name, shape, options, (takes, bodies))
}

/// The system with these functions, without an input.
fn of_shape<'a>(
    source: &'a Source,
    name: &Ident,
    shape: Shape,
    options: &Options,
    (takes, bodies): ([Option<Arguments>; Part::ALL.len()], Vec<Body>),
) -> System<'a> {
    System {
        source,
        name: name.clone(),
        degrees: shape.degrees,
        scalar: shape.scalar,
        rules: options.rules.clone(),
        engine: options.engine,
        bodies,
        takes,
        input: None,
        constraints: [None, None],
        values: [const { None }; Part::VALUES.len()],
        parameters: options.parameters.clone(),
        second: options.second,
        lanes: options.lanes.clone(),
        fused: options.fused.clone(),
    }
}
