//! The demands of constraints on a system, and of a system on its constraints.

use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::{Expr, Stmt};

use super::derived::Derived;
use super::diagnostics::{Mistake, Report};
use super::graph::{Graph, Node, Operation};
use super::lower::Lowered;
use super::model::{Engine, System};
use super::parts::Part;

/// Reports what the attribute asks for and steps on constraints do not have.
pub fn check(system: &System<'_>, report: &mut Report) {
    let Some(name) = Part::CONSTRAINTS.into_iter().find_map(|part| name_of(system, part)) else { return };
    let mut refuse = |lacks| report.at(&name, Mistake::Constrained { lacks });
    if system.rules.gauss {
        refuse("are held by `midpoint` and `trapezoidal`, and by compositions of these; leave `gauss` out");
    }
    if !system.rules.joint.is_empty() {
        refuse(
            "are held by `midpoint` and `trapezoidal`, and by compositions of these; leave the other rules out",
        );
    }
    if system.engine == Engine::NumDual {
        refuse("need derivatives that are written out; leave `derivatives = num_dual` out");
    }
    if system.lanes.words().next().is_some() {
        refuse("are not held in lanes; leave `lanes` out");
    }
    if system.second {
        refuse("have no second derivatives of a step; leave `step_derivatives` out");
    }
    if system.has(Part::TimeScale) {
        refuse("are not held over steps that follow a time scale; remove `time_scale`");
    }
}

/// Reports constraints that are more than the coordinates, a multiple of another, or do not hold q or v.
pub fn check_lowered(system: &System<'_>, lowered: &Lowered, report: &mut Report) {
    let graph = &lowered.graph;
    let count: usize = lowered.constraints.iter().map(Vec::len).sum();
    for (part, constraints) in Part::CONSTRAINTS.into_iter().zip(&lowered.constraints) {
        let Some(name) = name_of(system, part) else { continue };
        if constraints.is_empty() || count > lowered.n {
            let coordinates = lowered.n;
            let constraints = if constraints.is_empty() { 0 } else { count };
            report.at(&name, Mistake::ConstraintCount { constraints, coordinates });
            return;
        }
        let combinations: Vec<_> = constraints.iter().map(|&root| graph.combination(root)).collect();
        for (index, (&constraint, combination)) in constraints.iter().zip(&combinations).enumerate() {
            let at = tokens_of(system, part, index);
            let before = combinations[..index].iter().enumerate();
            let multiples = before.map(|(other, before)| (other, combination.multiple_of(before)));
            let mut found = multiples.filter_map(|(other, factor)| Some((other, factor?)));
            if let Some((other, factor)) = found.next() {
                report.at(&at, Mistake::ConstraintOnceMore { other, factor });
            } else if part == Part::Constraints && !reads(graph, constraint, is_coordinate) {
                report.at(&at, Mistake::ConstraintWithoutCoordinate);
            } else if part == Part::VelocityConstraints && !reads(graph, constraint, is_velocity) {
                report.at(&at, Mistake::ConstraintWithoutVelocity);
            }
        }
    }
}

/// Reports velocity constraints that are not linear in v.
pub fn check_derived(system: &System<'_>, derived: &Derived, report: &mut Report) {
    for &index in &derived.constraints.not_linear {
        let at = tokens_of(system, Part::VelocityConstraints, index);
        report.at(&at, Mistake::NotLinearInVelocity);
    }
}

fn is_coordinate(operation: Operation) -> bool {
    matches!(operation, Operation::Coordinate(_))
}

fn is_velocity(operation: Operation) -> bool {
    matches!(operation, Operation::Velocity(_))
}

fn reads(graph: &Graph, root: Node, is_read: fn(Operation) -> bool) -> bool {
    graph.reachable([root]).into_iter().any(|node| is_read(graph.operation(node)))
}

fn name_of(system: &System<'_>, part: Part) -> Option<syn::Ident> {
    let function = system.source.functions().find(|function| function.sig.ident == part.name());
    function.map(|function| function.sig.ident.clone())
}

/// The expression of a constraint, where the function ends in an array of them; otherwise its name.
fn tokens_of(system: &System<'_>, part: Part, index: usize) -> TokenStream {
    let mut functions = system.source.functions();
    let Some(function) = functions.find(|function| function.sig.ident == part.name()) else {
        return system.name.to_token_stream();
    };
    match function.block.stmts.last() {
        Some(Stmt::Expr(Expr::Array(array), None)) if array.elems.len() > index => {
            array.elems[index].to_token_stream()
        }
        _ => function.sig.ident.to_token_stream(),
    }
}
