//! The text of random systems against a tape that runs the data it is written of: equal to the last bit.
//!
//! The text is evaluated as it stands, without rustc: with one lane, or one member. Names of temporaries,
//! brackets, signs moved to factors, frames and the places of outputs are the text's alone, and held here.

mod systems;
mod text;
mod wrong;

use std::collections::HashMap;

use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::{ImplItem, Item};

use super::oracle::Random;
use crate::rayleigh_system::derived::{self, Derived, Kind, Of, Points, Routine};
use crate::rayleigh_system::graph::{Operation, interpret};
use crate::rayleigh_system::{Runtime, attribute, check, diagnostics::Report, lower, parse, rayleigh_system};
use systems::system;
use text::{Scope, Value};
use wrong::with_one_name;

/// The functions of a system as data; nothing where it has none.
fn data(attribute: TokenStream, item: TokenStream) -> Option<Derived> {
    let mut report = Report::default();
    let options = attribute::options(attribute, Runtime::STD, &mut report);
    let source = parse::source(item, &mut report).expect("a block");
    let system = check::system(&source, &options, &mut report).expect("a system");
    derived::functions(&system, lower::system(&system).ok()?).ok()
}

/// A function of an expansion.
struct Written {
    /// The trait.
    of: String,
    function: syn::ImplItemFn,
}

/// All functions of an expansion, each with the trait that it is of.
fn functions(expansion: TokenStream) -> Vec<Written> {
    let mut found = Vec::new();
    let items = syn::parse2::<syn::File>(expansion).expect("items").items;
    let mut open: Vec<Item> = items;
    while let Some(item) = open.pop() {
        match item {
            Item::Const(constant) => {
                if let syn::Expr::Block(block) = *constant.expr {
                    open.extend(block.block.stmts.into_iter().filter_map(|statement| match statement {
                        syn::Stmt::Item(item) => Some(item),
                        _ => None,
                    }));
                }
            }
            Item::Impl(block) => {
                let of = block.trait_.map(|(path, _)| path.to_token_stream().to_string().replace(' ', ""));
                for item in block.items {
                    if let (ImplItem::Fn(function), Some(of)) = (item, &of) {
                        found.push(Written { of: of.clone(), function });
                    }
                }
            }
            _ => {}
        }
    }
    found
}

/// The trait and the name of the function that is written of the routine.
fn name(routine: &Routine) -> (&'static str, String) {
    let is_of_members = matches!(routine.kind, Kind::Members { .. });
    let suffix = if is_of_members { "_in_lanes" } else { "" };
    match routine.of {
        Of::Gradient(part) => ("", format!("{}_gradient", part.name())),
        Of::Derivatives(part) => ("", format!("{}_derivatives", part.name())),
        Of::Variations => ("", "lagrangian_variations".to_owned()),
        Of::ForceDerivatives => ("Force", "force_derivatives".to_owned()),
        Of::TimeScaleGradient => ("", "time_scale_gradient".to_owned()),
        Of::ConstraintGradients => ("Constrained", "constraint_gradients".to_owned()),
        Of::ConstraintRounding => ("Constrained", "constraint_rounding".to_owned()),
        Of::ConstraintRates => ("Constrained", "constraint_rates".to_owned()),
        Of::ConstraintCurvature => ("Constrained", "constraint_curvature".to_owned()),
        Of::ConstraintsByParameters => ("", "constraints_by_parameters".to_owned()),
        Of::Slips => ("DryFriction", "slips".to_owned()),
        Of::SlipCurvature => ("DryFriction", "slip_curvature".to_owned()),
        Of::SlipsByParameters => ("", "slips_by_parameters".to_owned()),
        Of::SmoothRayleigh => ("SmoothRayleigh", "smooth_rayleigh_derivatives".to_owned()),
        Of::ForceByInput => ("", "force_by_input".to_owned()),
        Of::ByParameters(part) => ("", format!("{}_by_parameters", part.name())),
        Of::Along(part) => ("", format!("{}_along", part.name())),
        Of::CancellingTerms => ("ActingForce", "cancelling_terms".to_owned()),
        Of::StepKernel(Points::Middle) => ("Midpoint", format!("step_kernel{suffix}")),
        Of::StepKernel(Points::Ends) => ("Trapezoidal", "step_kernel".to_owned()),
        Of::Momenta(Points::Middle) => ("Midpoint", format!("momenta{suffix}")),
        Of::Momenta(Points::Ends) => ("Trapezoidal", "momenta".to_owned()),
        Of::StepMatrix => ("Explicit", "step_matrix".to_owned()),
        Of::VelocityMomenta => ("Explicit", format!("velocity_momenta{suffix}")),
        Of::ConfigurationForce => ("Explicit", format!("configuration_force{suffix}")),
        Of::Stages => ("", "stages".to_owned()),
        Of::Rates => ("", "rates_in_lanes".to_owned()),
        Of::Corrections => ("", "corrections_in_lanes".to_owned()),
        Of::Arguments(_) => ("", String::new()),
    }
}

/// Numbers for all that the functions of a system read.
fn numbers(random: &mut Random) -> HashMap<String, Value> {
    let mut number = || random.unit() * 2.4 - 0.8;
    let mut names = HashMap::new();
    for name in ["q", "v", "q0", "p", "momenta", "a", "b", "vector", "lambda"] {
        names.insert(name.to_owned(), Value::vector(&[number(), number()]));
    }
    let of_directions = ["minus.first", "minus.second", "plus.first", "plus.second"];
    for name in of_directions.into_iter().chain(["h", "elapsed", "self.m", "self.k", "self.t"]) {
        names.insert(name.to_owned(), Value::Number(number()));
    }
    // A characteristic.
    names.insert("self.cam".to_owned(), Value::Many(Vec::new()));
    names.insert("self.u".to_owned(), Value::vector(&[number()]));
    names.insert("p".to_owned(), names["momenta"].clone());
    for name in ["q0", "v", "h"] {
        names.insert(format!("segment.{name}"), names[name].clone());
    }
    names
}

/// The values of the routine, by the tape.
fn by_tape(derived: &Derived, routine: &Routine, given: &HashMap<String, Value>) -> Vec<f64> {
    let mut names = given.clone();
    let [h, time, elapsed] = ["h", "self.t", "elapsed"].map(|name| given[name].number());
    let half = 0.5 * h;
    let ahead = |step: f64| {
        let entries = (0..2).map(|i| given["q0"].at(i).number() + step * given["v"].at(i).number());
        Value::vector(&entries.collect::<Vec<_>>())
    };
    let present = match routine.of {
        Of::StepKernel(Points::Middle) | Of::Momenta(Points::Middle) => {
            names.insert("q".to_owned(), ahead(half));
            time + half
        }
        Of::Stages => elapsed + time,
        _ => time,
    };
    for (name, value) in [("half", half), ("t", present), ("t_end", time + h)] {
        names.insert(name.to_owned(), Value::Number(value));
    }
    names.extend([("q1".to_owned(), ahead(h)), ("u".to_owned(), given["self.u"].clone())]);
    let scope = Scope { names, sizes: [0, 0] };
    let at = |name: &str, index: usize| scope.names[name].at(index).number();
    let graph = &derived.graph;
    let given = |operation: Operation| match operation {
        Operation::Coordinate(i) => at("q", i),
        Operation::Velocity(i) => at("v", i),
        Operation::Input(i) => at("u", i),
        Operation::Parameter(i) => scope.tokens(graph.parameter(i).tokens.clone()).number(),
        other => panic!("{other:?} is computed"),
    };
    let mut values = interpret::values_of(graph, &routine.outputs, given, |x| x);
    // On members, a full matrix is written row by row.
    let is_full = values.len() == 6 && matches!(routine.of, Of::StepKernel(_));
    if is_full && matches!(routine.kind, Kind::Members { .. }) {
        values.swap(3, 4);
    }
    // The others are handed over, and looked at with what they lead to.
    values.truncate(if routine.of == Of::Rates { 2 } else { values.len() });
    values
}

/// The value of the function, by its text: all that its parameters can be is `given`.
fn by_text(all: &[Written], written: &Written, sizes: [usize; 2], given: &HashMap<String, Value>) -> Value {
    let read = |name: &str| match name {
        "fields" => {
            let of_members = all.iter().find(|other| other.function.sig.ident == name);
            by_text(all, of_members.expect("the function that gathers fields"), sizes, given)
        }
        "kept" => {
            let rates = all.iter().find(|other| other.function.sig.ident == "rates_in_lanes");
            by_text(all, rates.expect("the rates"), sizes, given).at(1).clone()
        }
        name => given.get(name).cloned().unwrap_or(Value::Many(Vec::new())),
    };
    let is_member = |name: &&String| name.contains('.');
    let mut names: HashMap<String, Value> =
        given.keys().filter(is_member).map(|name| (name.clone(), given[name].clone())).collect();
    for input in &written.function.sig.inputs {
        if let syn::FnArg::Typed(typed) = input {
            let name = typed.pat.to_token_stream().to_string();
            let value = read(&name);
            names.insert(name, value);
        }
    }
    Scope { names, sizes }.block(&written.function.block)
}

/// The function that is written of the routine.
fn written_of<'a>(all: &'a [Written], routine: &Routine) -> Option<&'a Written> {
    let (of, name) = name(routine);
    all.iter().find(|written| {
        let own = written.function.sig.ident.to_string();
        // The view hands some on to the system.
        let body = written.function.block.to_token_stream().to_string();
        let is_own = own == name || own.strip_suffix("_in_time") == Some(&name);
        is_own && written.of.contains(of) && !body.contains("(self . system , q")
    })
}

/// Whether text and tape agree to the last bit.
fn agree(
    derived: &Derived,
    routine: &Routine,
    all: &[Written],
    written: &Written,
    random: &mut Random,
) -> bool {
    let given = numbers(random);
    let count = routine.outputs.len();
    let matrix = match routine.of {
        Of::ByParameters(part) if part.name() != "force" => count / 2,
        Of::ByParameters(_) | Of::ForceByInput => count,
        _ => 4,
    };
    let tape = by_tape(derived, routine, &given);
    let mut text = by_text(all, written, [2, matrix], &given).flat();
    text.truncate(if routine.of == Of::Rates { 2 } else { text.len() });
    // Of blocks that are 0 the text does not say how large they are.
    let is_short = matches!(routine.of, Of::Along(_));
    let same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
    (is_short || text.len() == tape.len()) && text.iter().zip(&tape).all(same)
}

/// All that is derived of the systems, with the text that is written of it.
fn each(seeds: std::ops::Range<u64>, mut look: impl FnMut(u64, &Derived, &Routine, &[Written], &Written)) {
    for seed in seeds {
        let (attribute, item) = system(seed);
        let expansion = rayleigh_system(Runtime::STD, attribute.clone(), item.clone());
        let is_refused = expansion.to_string().contains("compile_error");
        let Some(derived) = data(attribute, item).filter(|_| !is_refused) else { continue };
        let all = functions(expansion);
        let kernels = derived.kernels.iter().flatten();
        let of_steps = kernels.flat_map(|kernel| {
            let explicit = kernel.explicit.iter().flat_map(|explicit| {
                let own = [&explicit.matrix, &explicit.momenta, &explicit.force];
                own.into_iter().chain(explicit.in_lanes.iter().flatten())
            });
            [&kernel.step_kernel, &kernel.momenta]
                .into_iter()
                .chain(kernel.in_lanes.iter().flatten())
                .chain(explicit)
        });
        let stages = derived.stages.iter().flatten();
        let of_stages =
            stages.flat_map(|stages| [&stages.at_once].into_iter().chain(stages.in_lanes.iter().flatten()));
        for routine in derived.functions.iter().chain(of_steps).chain(of_stages) {
            let written = written_of(&all, routine).unwrap_or_else(|| panic!("{seed}: {:?}", name(routine)));
            look(seed, &derived, routine, &all, written);
        }
    }
}

#[test]
fn the_text_computes_what_the_data_says() {
    let count = if cfg!(debug_assertions) { 60 } else { 600 };
    let mut seen = std::collections::BTreeMap::new();
    each(0..count, |seed, derived, routine, all, written| {
        let mut random = Random(seed);
        assert!(
            (0..3).all(|_| agree(derived, routine, all, written, &mut random)),
            "{seed}: {:?}",
            name(routine)
        );
        *seen.entry(written.function.sig.ident.to_string()).or_insert(0) += 1;
    });
    println!("{seen:?}");
    assert!(seen.len() == 33 && seen.values().sum::<i32>() > 10 * count as i32, "{seen:?}");
}

/// The control: one name for two temporaries, or two outputs in each other's place, is found.
#[test]
fn a_wrong_text_and_a_wrong_value_are_found() {
    let (mut texts, mut found_texts, mut values, mut found_values) = (0, 0, 0, 0);
    each(0..40, |seed, derived, routine, all, written| {
        let mut random = Random(seed);
        if let Some(wrong) = with_one_name(written) {
            texts += 1;
            found_texts += usize::from(!agree(derived, routine, all, &wrong, &mut random));
        }
        let &Routine { of, home, ref outputs, .. } = routine;
        if matches!(routine.kind, Kind::Numbers) && outputs[0] != outputs[1] {
            let mut outputs = outputs.clone();
            outputs.swap(0, 1);
            values += 1;
            let wrong = Routine { of, home, kind: Kind::Numbers, outputs };
            found_values += usize::from(!agree(derived, &wrong, all, written, &mut random));
        }
    });
    println!("{found_texts} of {texts} texts, {found_values} of {values} values");
    assert!(texts > 100 && 5 * found_texts > 4 * texts, "{found_texts} of {texts} texts");
    assert!(values > 100 && 10 * found_values > 9 * values, "{found_values} of {values} values");
}
