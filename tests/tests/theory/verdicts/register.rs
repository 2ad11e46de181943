//! Every verdict of a public type is tried on nonsense, in the files `poisoned` of this folder: what the
//! source of the checkers answers with a bool, and what it says otherwise.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Verdicts, as `Type::name`.
const BOOLEANS: [&str; 25] = [
    "Balance::is_balanced",
    "Closure::is_closed",
    "Condition::holds",
    "ConformalStep::is_conformal",
    "Dissipation::is_dissipative",
    "Equivalence::has_same_equations",
    "Equivalence::is_gauge",
    "Finding::vanishes",
    "ModifiedLinearSystem::is_dissipative",
    "ModifiedLinearSystem::is_rayleigh",
    "Proportion::is_constant",
    "RankDecision::is_clear",
    "RayleighEquation::is_rayleigh",
    "RayleighStep::is_rayleigh",
    "RayleighStructure::allows_resplit",
    "RayleighStructure::is_rayleigh",
    "Recovery::exists",
    "ResplitReport::exists",
    "Residual::holds",
    "SolutionReport::is_solution",
    "Subalgebra::premise_holds",
    "Symmetry::force_does_work",
    "Symmetry::is_conserved",
    "Symmetry::is_consistent",
    "Symmetry::is_symmetry_of_lagrangian",
];

/// What says yes otherwise: by an enum, a number, in words or by being no error.
const OTHERS: [&str; 8] = [
    ".verdict()",
    ".dimension()",
    "on_the_branch_of_the_flow",
    "equal to rounding",
    "no caustic",
    ".routh::<",
    ".conformal_hamilton_jacobi(",
    ".largest_step(",
];

/// `Type::name` of the public functions of a source that return a bool.
fn verdicts(source: &str) -> BTreeSet<String> {
    let (mut of, mut found) = (String::new(), BTreeSet::new());
    let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    for line in source.lines() {
        if let Some(rest) = line.strip_prefix("impl") {
            // Past the parameters, which may be in brackets themselves.
            let mut depth = 0;
            let past = rest.find(|c: char| {
                depth += i32::from(c == '<') - i32::from(c == '>');
                depth == 0 && c == ' '
            });
            of = word(rest[past.unwrap_or(0)..].trim_start());
        }
        if line.contains("-> bool")
            && let Some((_, rest)) = line.split_once("pub fn ").or_else(|| line.split_once("pub const fn "))
        {
            found.insert(format!("{of}::{}", word(rest)));
        }
    }
    found
}

/// All sources under a folder, tests in them left out.
fn sources(folder: &Path, add: &mut dyn FnMut(&str)) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, add);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let source = fs::read_to_string(&path).unwrap();
            add(source.split("#[cfg(test)]").next().unwrap());
        }
    }
}

#[test]
fn every_verdict_is_tried_on_nonsense() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut declared = BTreeSet::new();
    sources(&project.join("../runtime/src/theory"), &mut |source| declared.extend(verdicts(source)));
    let listed = BTreeSet::from(BOOLEANS.map(String::from));
    let difference: Vec<_> = declared.symmetric_difference(&listed).collect();
    assert!(difference.is_empty(), "declared or listed here, but not both: {difference:#?}");

    let mut tried = String::new();
    for file in ["poisoned.rs", "poisoned_sections.rs", "poisoned_steps.rs"] {
        tried += &fs::read_to_string(project.join("tests/theory/verdicts").join(file)).unwrap();
    }
    let called = |name: &str| tried.contains(&format!(".{}()", name.split_once("::").unwrap().1));
    let untried: Vec<_> = BOOLEANS.iter().filter(|name| !called(name)).collect();
    assert!(untried.is_empty(), "{untried:?}");
    let untried: Vec<_> = OTHERS.iter().filter(|text| !tried.contains(**text)).collect();
    assert!(untried.is_empty(), "{untried:?}");
    assert!(!called("Subalgebra::is_never_declared"));
}

#[test]
fn verdicts_are_found_in_a_source() {
    let source = "impl<P: Into<Q<N>>, const N: usize> Report<P, N> {\n    pub fn holds(&self) -> bool {\n    fn own(&self) -> bool {\n\
                  impl Plain {\n    pub const fn is_so(&self) -> bool { true }\n    pub fn size(&self) -> f64 {";
    assert_eq!(verdicts(source), BTreeSet::from(["Report::holds", "Plain::is_so"].map(String::from)));
}
