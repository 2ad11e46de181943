//! Operations of L, R, f and constraints that have no derivative at some arguments, for the errors of steps.
//!
//! The arguments are written out, each with the condition that its operation stands under: what a rejected
//! branch holds is no cause.

use std::collections::HashMap;

use super::super::functions::Singularity;
use super::super::graph::{Function, PairFunction};
use super::*;

/// The most operations of functions that are looked at: no system is to be refused for the length of what an
/// error asks for.
const MOST: usize = MOST_OPERATIONS / 8;

/// The most operations that one function is asked about.
const MOST_PLACES: usize = 64;

/// The operations of L, R, a component of f or a constraint that have no derivative at some arguments.
pub struct Places {
    pub part: Part,
    /// The component of f, or the constraint; 0 of L and R.
    pub index: usize,
    pub places: Vec<Place>,
    /// One or two for each operation.
    pub arguments: Routine,
}

/// An operation that has no derivative at some arguments.
pub struct Place {
    /// Its name in the runtime.
    pub name: &'static str,
    /// The user's text.
    pub text: String,
    pub has_second: bool,
}

/// [`Place`] on a graph.
struct Singular {
    singularity: Singularity,
    argument: Node,
    second: Option<Node>,
}

impl Deriving<'_> {
    /// The operations without a derivative, of the system and of its view if that has more functions.
    pub(super) fn places(&mut self, constraints: &[Vec<Node>; 2]) -> [Vec<Places>; 2] {
        [Home::System, Home::View].map(|home| {
            let has = |part: Part| home == Home::View || self.system.home_of(part) == home;
            if home == Home::View && !self.system.has_view() {
                return Vec::new();
            }
            let alone = [(Part::Lagrangian, self.lagrangian)].into_iter();
            let alone = alone.chain(self.rayleigh.map(|root| (Part::Rayleigh, root)));
            let force = self.force.unwrap_or_default().iter().enumerate();
            let force = force.map(|(index, &root)| (Part::Force, index, root));
            let held = constraints.iter().flatten().enumerate();
            let held = held.map(|(index, &root)| (Part::Constraints, index, root));
            let all = alone.map(|(part, root)| (part, 0, root)).chain(force).chain(held);
            let own: Vec<_> = all.filter(|&(part, ..)| has(part)).collect();
            let places = own.into_iter().filter_map(|(part, index, root)| {
                let (places, arguments) = self.singular_operations(root);
                if places.is_empty() {
                    return None;
                }
                let arguments = self.made(Of::Arguments(part), home, &arguments).ok()?;
                Some(Places { part, index, places, arguments })
            });
            places.collect()
        })
    }

    /// The operations that can lack a derivative, arguments first; and the arguments.
    fn singular_operations(&mut self, root: Node) -> (Vec<Place>, Vec<Node>) {
        let (mut written, mut outputs) = (Vec::new(), Vec::new());
        if self.graph.is_full() || self.graph.operations([root]) > MOST {
            return (written, outputs);
        }
        let is_function = matches!(self.system.source, super::super::model::Source::Function(_));
        let nodes = self.graph.reachable([root]);
        let singular: Vec<_> =
            nodes.iter().filter_map(|&node| Some((node, self.singular(node)?))).take(MOST_PLACES).collect();
        if singular.is_empty() {
            return (written, outputs);
        }
        let conditions = self.conditions(root, &nodes);
        for (node, Singular { singularity: Singularity { name, regular }, argument, second }) in singular {
            // Nothing where only conditions hold it: those are not differentiated.
            let Some(&condition) = conditions.get(&node) else { continue };
            let argument = match condition {
                None => argument,
                Some(condition) => {
                    let regular = self.graph.constant(regular);
                    self.graph.select(condition, argument, regular)
                }
            };
            let own = [argument].into_iter().chain(second);
            if !self.graph.is_conditional(own.clone()) {
                outputs.extend(own);
                let text = self.graph.spelled(node, is_function);
                written.push(Place { name, text, has_second: second.is_some() });
            }
        }
        (written, outputs)
    }

    /// The operation, if it can lack a derivative by q, v or u.
    fn singular(&self, node: Node) -> Option<Singular> {
        let (singularity, argument, second) = match self.graph.operation(node) {
            Operation::Function(function, s) => (function.singularity()?, s, None),
            Operation::Pair(PairFunction::Powf, _, y)
                if self.graph.constant_value(y).is_some_and(|y| y >= 0.0 && y % 1.0 == 0.0) =>
            {
                return None;
            }
            Operation::Pair(function, s, second) => (function.singularity()?, s, Some(second)),
            Operation::Divide(_, s) => (Function::Recip.singularity()?, s, None),
            Operation::Power(s, n) if n < 0 => (Function::Recip.singularity()?, s, None),
            _ => return None,
        };
        let depends = |node: Node| self.graph.depends(node);
        (depends(argument) || second.is_some_and(depends)).then_some(Singular {
            singularity,
            argument,
            second,
        })
    }

    /// The conditions that `nodes`, all that `root` is made of, stand under; nothing for those that are
    /// always computed. Absent where only conditions need them.
    fn conditions(&mut self, root: Node, nodes: &[Node]) -> HashMap<Node, Option<Node>> {
        let mut conditions: HashMap<Node, Option<Node>> = HashMap::from([(root, None)]);
        for &node in nodes.iter().rev() {
            let Some(&own) = conditions.get(&node) else { continue };
            let operation = self.graph.operation(node);
            let needed = match operation {
                Operation::Select(condition, a, b) => {
                    let otherwise = self.graph.node(Operation::Not(condition));
                    let mut under = |branch: Node| match own {
                        None => branch,
                        Some(own) => self.graph.node(Operation::And(own, branch)),
                    };
                    vec![(a, Some(under(condition))), (b, Some(under(otherwise)))]
                }
                operation if operation.is_truth() => Vec::new(),
                operation => operation.arguments().map(|argument| (argument, own)).collect(),
            };
            for (argument, condition) in needed {
                let both = match (conditions.get(&argument), condition) {
                    (None, condition) => condition,
                    (Some(Some(other)), Some(own)) if *other == own => Some(own),
                    (Some(Some(other)), Some(own)) => Some(self.graph.node(Operation::Or(*other, own))),
                    _ => None,
                };
                conditions.insert(argument, both);
            }
        }
        conditions
    }
}
