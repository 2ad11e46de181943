//! What `lanes = explicit` asks of a system.

use super::diagnostics::{Mistake, Report};
use super::model::{Engine, System};
use super::structure::{Damping, Findings};

/// Reports what can be told from the attribute and the signatures.
pub fn check(system: &System<'_>, report: &mut Report) {
    let Some(word) = &system.lanes else { return };
    let lacks = if system.engine == Engine::NumDual {
        "needs the derivatives written out, and `derivatives = num_dual` leaves them to the run"
    } else if system.timed.any() {
        "takes no time: L, R and f have to be functions of q, v, the input and the fields"
    } else if !system.rules.of_displacement.iter().any(|rule| rule.may_be_explicit()) {
        "needs the rule whose steps are explicit; add `rule = trapezoidal`"
    } else {
        return;
    };
    report.at(word, Mistake::Lanes { lacks });
}

/// Reports what the expressions show: why steps are not explicit, or the force is not for lanes.
pub fn check_written(
    system: &System<'_>,
    findings: Option<&Findings>,
    is_written: bool,
    report: &mut Report,
) {
    if let (Some(word), Some(findings), false) = (&system.lanes, findings, is_written) {
        report.at(word, Mistake::Lanes { lacks: why_implicit(findings) });
    }
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
    } else {
        "needs explicit steps, and the force depends on v: it has to be a function of q"
    }
}
