//! The methods that a system is run by.

use std::fmt::Write as _;

use super::system::{Kind, System, Text};

/// Steps of a run at most: long after it has come to rest.
const MOST_STEPS: u64 = 1_000_000;

/// Its name, what it asks of the attribute, and how it is made.
pub struct Method {
    pub name: &'static str,
    rule: &'static str,
    lanes: &'static str,
    made: &'static str,
    least: Kind,
}

const fn of(name: &'static str, rule: &'static str, made: &'static str) -> Method {
    Method { name, rule, lanes: "", made, least: Kind::General }
}

const fn of_separable(name: &'static str, rule: &'static str, made: &'static str) -> Method {
    Method { least: Kind::Separable, ..of(name, rule, made) }
}

const fn in_lanes(name: &'static str, lanes: &'static str, method: Method) -> Method {
    Method { name, lanes, ..method }
}

/// All methods.
pub const METHODS: [Method; 17] = [
    of("midpoint", "midpoint", "Midpoint"),
    of("trapezoidal", "trapezoidal", "Trapezoidal"),
    of("one_sided", "one_sided", "OneSided"),
    of("gauss_1", "gauss", "Gauss::<1>"),
    of("gauss_2", "gauss", "Gauss::<2>"),
    of("gauss_3", "gauss", "Gauss::<3>"),
    of("gauss_4", "gauss", "Gauss::<4>"),
    of("gauss_8", "gauss", "Gauss::<8>"),
    of("composition_6", "midpoint", "Composition::kahan_li_6(Midpoint)"),
    of("composition_trapezoidal", "trapezoidal", "Composition::kahan_li_6(Trapezoidal)"),
    in_lanes("midpoint_in_lanes", "midpoint", of("", "midpoint", "Midpoint")),
    in_lanes("gauss_in_lanes", "gauss", of("", "gauss", "Gauss::<3>")),
    of_separable("splitting_6", "trapezoidal", "Splitting::blanes_moan_6()"),
    of_separable("splitting_8", "trapezoidal", "Splitting::blanes_casas_escorihuela_8()"),
    of_separable("fitted", "fitted", "Fitted"),
    of_separable("fitted_trapezoidal", "fitted_trapezoidal", "FittedTrapezoidal"),
    in_lanes("splitting_in_lanes", "explicit", of_separable("", "trapezoidal", "Splitting::blanes_moan_6()")),
];

/// The methods of a system: all that can step it, or some of them.
pub fn of_system(system: &System, most: usize) -> Vec<&'static Method> {
    // What dual numbers leave to the run has no structure that is known.
    let is_seen = system.engine == "expanded";
    let can = |method: &&Method| {
        let is_general =
            method.least == Kind::General && method.lanes.is_empty() && method.rule != "one_sided";
        method.least <= system.kind && (is_seen || is_general)
    };
    let all: Vec<&Method> = METHODS.iter().filter(can).collect();
    let stride = all.len().div_ceil(most.min(all.len()));
    all.into_iter().skip(system.seed as usize % stride).step_by(stride).collect()
}

/// The module of some systems that differ in their numbers alone: their text, and a function that runs each
/// for so long, in its unit of time.
pub fn module(systems: &[System], methods: &[&Method], time: f64) -> String {
    let listed = |of: &dyn Fn(&Method) -> &'static str| {
        let mut words: Vec<_> =
            methods.iter().map(|method| of(method)).filter(|word| !word.is_empty()).collect();
        words.sort_unstable();
        words.dedup();
        words.join(", ")
    };
    let (rules, lanes) = (listed(&|method| method.rule), listed(&|method| method.lanes));
    let System { seed, n, engine, .. } = systems[0];
    let mut attribute = format!("rule = [{rules}], derivatives = {engine}");
    if !lanes.is_empty() {
        write!(attribute, ", lanes = [{lanes}]").expect("a string takes all");
    }
    let Text { declared, block, values } = Text::of(systems, &attribute);
    let mut drawn = String::new();
    for (system, value) in systems.iter().zip(&values) {
        let (q, v, h) = system.start();
        let steps = ((time / system.h).ceil() as u64).min(MOST_STEPS);
        writeln!(drawn, "({value}, {q:?}, {v:?}, {h:e}, {steps}),").expect("a string takes all");
    }
    let mut calls = String::new();
    for Method { name, lanes, made, .. } in methods {
        let run = if lanes.is_empty() { "run" } else { "lanes" };
        writeln!(calls, "{run}({seed}, member, {name:?}, system, {made}, &start, h, steps);")
            .expect("a string takes all");
    }
    let count = systems.len();
    format!(
        "mod s{seed} {{\nuse super::*;\nuse dalembert::rayleigh_system;\n{declared}\n{block}\n\
         const SYSTEMS: [(System, [f64; {n}], [f64; {n}], f64, u64); {count}] = [\n{drawn}];\n\
         pub fn all() {{\nfor (member, (system, q, v, h, steps)) in SYSTEMS.iter().enumerate() {{\n\
         let (h, steps) = (*h, *steps);\nlet start = start(system, *q, *v);\n{calls}}}\n}}\n}}\n"
    )
}
