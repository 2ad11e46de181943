//! Names of temporaries: the user's own, or what the expression is.

use std::collections::{HashMap, HashSet};

use proc_macro2::Span;
use syn::Ident;

use super::super::graph::{Graph, Node, Operation};

/// The names given within one function.
pub struct Names {
    taken: HashSet<String>,
    /// The last number behind each name.
    numbers: HashMap<String, usize>,
    unnamed: usize,
}

impl Names {
    pub fn new(graph: &Graph, taken: &[&str]) -> Self {
        let taken = taken.iter().map(|&name| name.to_owned());
        Self { taken: taken.chain(graph.reserved().cloned()).collect(), numbers: HashMap::new(), unnamed: 0 }
    }

    /// A name for the node that nothing else in the function has; `locals` have theirs.
    pub fn of(&mut self, graph: &Graph, node: Node, locals: &[Option<Ident>]) -> Ident {
        let name = match described(graph, node, locals) {
            Some(name) => name,
            None => {
                self.unnamed += 1;
                format!("t{}", self.unnamed)
            }
        };
        // A keyword that the user wrote raw.
        let name = if syn::parse_str::<Ident>(&name).is_ok() { name } else { format!("{name}_") };
        let mut unique = name.clone();
        let number = self.numbers.entry(name.clone()).or_insert(1);
        while !self.taken.insert(unique.clone()) {
            *number += 1;
            unique = format!("{name}_{number}");
        }
        Ident::new(&unique, span(graph, node))
    }
}

/// The span of the name: at the user's tokens for what stands for them. Where the module has a static of that
/// name, rustc refuses the local there, and not at the attribute.
fn span(graph: &Graph, node: Node) -> Span {
    let place = match graph.operation(node) {
        Operation::Parameter(index) => graph.parameter(index).tokens.clone().into_iter().last(),
        _ => None,
    };
    place.map_or_else(Span::call_site, |token| Span::call_site().located_at(token.span()))
}

/// The user's name, or one made of those of the arguments.
fn described(graph: &Graph, node: Node, locals: &[Option<Ident>]) -> Option<String> {
    if let Some(name) = graph.name(node)
        && !name.is_empty()
    {
        return Some(name.to_owned());
    }
    match graph.operation(node) {
        Operation::Function(function, x) => Some(format!("{}_{}", function.name(), short(graph, x, locals)?)),
        Operation::Characteristic(curve, _) => graph.name_of_curve(curve),
        Operation::Multiply(a, b) if a == b => Some(format!("{}_squared", short(graph, a, locals)?)),
        _ => None,
    }
}

/// The name of a variable, a local or a named expression.
fn short(graph: &Graph, node: Node, locals: &[Option<Ident>]) -> Option<String> {
    if let Some(local) = &locals[node.index()] {
        return Some(local.to_string());
    }
    match graph.operation(node) {
        Operation::Coordinate(index) => Some(format!("q{index}")),
        Operation::Velocity(index) => Some(format!("v{index}")),
        Operation::Input(index) => Some(format!("u{index}")),
        _ => graph.name(node).map(str::to_owned),
    }
}
