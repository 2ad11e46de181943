//! The demands of the rules that take L and R together, checked on the expressions of L and R as they are
//! written.

use super::diagnostics::{Mistake, Report};
use super::differentiate::{Derivatives, Differentiation};
use super::graph::{Graph, Node, Operation};
use super::lower::Lowered;
use super::model::{Engine, System};
use super::parts::Part;
use super::rules::Joint;

/// Reports what the system lacks for each such rule. `lowered` is nothing where derivatives are not written
/// out.
pub fn check(system: &System<'_>, lowered: Option<&Lowered>, report: &mut Report) {
    for (word, rule) in &system.rules.joint {
        if let Some(lacks) = rule.joint().and_then(|joint| lacks(joint, system, lowered)) {
            report.at(word, Mistake::JointRule { rule: word.to_string(), lacks });
        }
    }
}

/// The first demand of `rule` that the system does not meet, if any.
fn lacks(rule: Joint, system: &System<'_>, lowered: Option<&Lowered>) -> Option<&'static str> {
    if let Some(lacks) = asked_too_much(rule, system) {
        return Some(lacks);
    }
    if !system.has(Part::Rayleigh) {
        return Some("needs a Rayleigh function, and there is none");
    }
    if !rule.is_fitted {
        return None;
    }
    if system.has(Part::Force) {
        return Some("takes no general force");
    }
    if system.engine == Engine::NumDual {
        return Some("needs to see L and R, which `derivatives = num_dual` leaves to the run");
    }
    let Some(Lowered { graph, lagrangian, rayleigh: Some(rayleigh), .. }) = lowered else {
        return Some(
            "needs to see L and R, and these bodies cannot be written out (`derivatives = expanded` says why)",
        );
    };
    // What is looked at here leaves no trace in what is written.
    let (mut graph, mut derivation) = (graph.clone(), Differentiation::default());
    let r = derivation.hessian(&mut graph, *rayleigh, "r");
    if r.gradient.keys().any(|&variable| is_coordinate(&graph, variable)) {
        return Some("needs a Rayleigh function of v alone");
    }
    if r.hessian.values().any(|&entry| graph.depends(entry)) {
        return Some("needs linear damping, R = ½vᵀCv with constant C");
    }
    let l = derivation.hessian(&mut graph, *lagrangian, "l");
    (!is_natural(&graph, &l)).then_some("needs L = ½vᵀMv − V(q) with constant M")
}

/// Names what the system asks for and rules that take L and R together do not have: a view, or derivatives
/// on request.
fn asked_too_much(rule: Joint, system: &System<'_>) -> Option<&'static str> {
    if !rule.is_fitted {
        return system.second.then_some("does not have the derivatives that `step_derivatives` asks for");
    }
    if system.has_view() {
        return Some("takes neither input nor time");
    }
    let on_request = system.second || !system.parameters.is_empty();
    on_request.then_some("does not have the derivatives that `parameters` and `step_derivatives` ask for")
}

/// ∂²L/∂v² constant, ∂²L/∂q∂v absent.
fn is_natural(graph: &Graph, l: &Derivatives) -> bool {
    l.hessian.iter().all(|(&(a, b), &entry)| match (is_coordinate(graph, a), is_coordinate(graph, b)) {
        (true, true) => true,
        (false, false) => !graph.depends(entry),
        _ => graph.constant_value(entry) == Some(0.0),
    })
}

fn is_coordinate(graph: &Graph, variable: Node) -> bool {
    matches!(graph.operation(variable), Operation::Coordinate(_))
}
