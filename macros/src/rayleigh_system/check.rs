//! From the annotated item to the system that its signatures state.

mod place;
mod shape;
mod signature;

use quote::ToTokens;
use syn::{ImplItemFn, Type};

use super::attribute::Options;
use super::diagnostics::{Mistake, Report};
use super::model::{Body, Degrees, Function, RayleighArguments, Source, System, Timed};
use place::{Parameter, Place, at_field, at_place};
use shape::{Shape, is, same_shape, shape_of};
pub use signature::qualifiers;
use signature::{
    force_signature, lagrangian_signature, rayleigh_signature, result, result_tokens, time_scale_signature,
    typed_parameters,
};

/// The system as far as its signatures tell, or nothing if not even N is known; every wrong one is reported.
pub fn system<'a>(source: &'a Source, options: &Options, report: &mut Report) -> Option<System<'a>> {
    match source {
        Source::Block(_) => block(source, options, report),
        Source::Function(function) => free_function(source, function, options, report),
    }
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
    let time_scale = named("time_scale");
    if let Some(time_scale) = time_scale {
        let before = report.count();
        time_scale_signature(&time_scale.sig, &shape, report);
        keep(time_scale, before, report);
    }
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
        has_time_scale: time_scale.is_some(),
        input: input.map(|length| Degrees { length, system: source.name().clone() }),
        timed,
        parameters: options.parameters.clone(),
        second: options.second,
        lanes: options.lanes.clone(),
        fused: options.fused.clone(),
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
    for ((name, _), place) in parameters.iter().zip([Place::Configuration, Place::Velocity]) {
        at_place(*name, place, report);
    }
    for field in &fields {
        at_field(*field, report);
    }
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
    Some((function_system(source, function, shape, &Options::default(), None, has_right_signature), field))
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
        has_time_scale: false,
        input: None,
        timed: Timed::default(),
        parameters: options.parameters.clone(),
        second: options.second,
        lanes: options.lanes.clone(),
        fused: options.fused.clone(),
    }
}
