//! The demands of `lanes = explicit`, `lanes = midpoint` and `lanes = gauss` on a system.

use syn::Ident;

use super::derived::{CONDITIONAL, Derived};
use super::diagnostics::{Mistake, Report};
use super::model::{Engine, System};
use super::rules::Rule;
use super::structure::{Damping, Findings};

/// Reports what can be told from the attribute and the signatures.
pub fn check(system: &System<'_>, report: &mut Report) {
    for word in system.lanes.words() {
        if system.engine == Engine::NumDual {
            refuse(
                word,
                "needs the derivatives written out, and `derivatives = num_dual` leaves them to the run",
                report,
            );
        }
    }
    if !report.is_empty() {
        return;
    }
    if let Some(word) = &system.lanes.explicit
        && !system.rules.of_displacement.iter().any(|rule| rule.may_be_explicit())
    {
        refuse(word, "needs the rule whose steps are explicit; add `rule = trapezoidal`", report);
    }
    if let Some(word) = &system.lanes.midpoint
        && !system.rules.of_displacement.contains(&Rule::Midpoint)
    {
        refuse(word, "needs the midpoint rule; list it, `rule = midpoint`", report);
    }
    if let Some(word) = &system.lanes.gauss
        && !system.rules.gauss
    {
        refuse(word, "needs the rules of Gauss; add `rule = gauss`", report);
    }
}

/// Reports what the expressions show: why steps are not explicit, or the derivatives are not for lanes.
pub fn check_derived(system: &System<'_>, derived: &Derived, report: &mut Report) {
    if let (Some(word), false) = (&system.lanes.explicit, derived.has_explicit_lanes()) {
        refuse(word, why_implicit(&derived.findings), report);
    }
    if let (Some(word), false) = (&system.lanes.midpoint, derived.has_midpoint_lanes()) {
        refuse(word, CONDITIONAL, report);
    }
    if let (Some(word), Some(Err(lacks))) = (&system.lanes.gauss, &derived.stages) {
        refuse(word, lacks, report);
    }
}

fn refuse(word: &Ident, lacks: &'static str, report: &mut Report) {
    report.at(word, Mistake::Lanes { word: word.to_string(), lacks });
}

fn why_implicit(findings: &Findings) -> &'static str {
    if findings.newton.iter().any(|newton| newton.is_explicit) {
        "reads all fields before the run, and the force reads one within a condition, where it may panic; read it before the condition"
    } else if !findings.constant_mass_matrix {
        "needs explicit steps, and ∂²L/∂v² is not constant: L has to be ½vᵀMv − V(q)"
    } else if !matches!(findings.damping, Damping::Absent | Damping::Linear) {
        "needs explicit steps, and the friction is not linear in v: R has to be ½vᵀCv with constant C"
    } else if !findings.separable_lagrangian {
        "needs explicit steps, and a term of L holds both q and v: L has to be ½vᵀMv − V(q)"
    } else if findings.timed_momenta {
        "needs explicit steps, and ∂L/∂v takes the time: L has to be ½vᵀMv − V(q, t)"
    } else {
        "needs explicit steps, and the force depends on v: it has to be a function of q"
    }
}
