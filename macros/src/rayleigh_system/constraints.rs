//! The demands of constraints on a system, and of a system on its constraints.

use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::{Expr, Ident, Stmt};

use super::diagnostics::{Mistake, Report};
use super::lower::Lowered;
use super::model::{Engine, System};
use super::parts::Part;

/// Reports what the attribute asks for and steps on constraints do not have.
pub fn check(system: &System<'_>, report: &mut Report) {
    let Some(name) = name_of(system) else { return };
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
    if system.second || !system.parameters.is_empty() {
        refuse(
            "have no derivatives of a step but those by its state; leave `parameters` and `step_derivatives` out",
        );
    }
    if system.has(Part::TimeScale) {
        refuse("are not held over steps that follow a time scale; remove `time_scale`");
    }
}

/// Reports constraints that are more than the coordinates, equal to another, or do not hold q.
pub fn check_lowered(system: &System<'_>, lowered: &Lowered, report: &mut Report) {
    let (Some(name), Some(constraints)) = (name_of(system), &lowered.constraints) else { return };
    if constraints.is_empty() || constraints.len() > lowered.n {
        report.at(&name, Mistake::ConstraintCount { constraints: constraints.len(), coordinates: lowered.n });
        return;
    }
    for (index, &constraint) in constraints.iter().enumerate() {
        let at = tokens_of(system, index);
        if let Some(other) = constraints[..index].iter().position(|&before| before == constraint) {
            report.at(&at, Mistake::EqualConstraints { other });
        } else if !lowered.graph.depends(constraint) {
            report.at(&at, Mistake::ConstraintWithoutCoordinate);
        }
    }
}

fn name_of(system: &System<'_>) -> Option<Ident> {
    let function = system.source.functions().find(|function| function.sig.ident == Part::Constraints.name());
    function.map(|function| function.sig.ident.clone())
}

/// The expression of a constraint, where the function ends in an array of them; otherwise its name.
fn tokens_of(system: &System<'_>, index: usize) -> TokenStream {
    let mut functions = system.source.functions();
    let Some(function) = functions.find(|function| function.sig.ident == Part::Constraints.name()) else {
        return system.name.to_token_stream();
    };
    match function.block.stmts.last() {
        Some(Stmt::Expr(Expr::Array(array), None)) if array.elems.len() > index => {
            array.elems[index].to_token_stream()
        }
        _ => function.sig.ident.to_token_stream(),
    }
}
