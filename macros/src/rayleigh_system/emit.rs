//! From expressions to straight-line code that reads as if written by hand.
//!
//! A `let` holds each value that is used more than once or that the user named, and each selection; the rest
//! stands where it is used. Only what the outputs need is written, in the order in which it was found, so
//! that equal systems give equal text.
//!
//! Code on lanes has the text of code on numbers, but for what `lanes.rs` writes otherwise.

mod characteristic;
mod expression;
mod inlined;
mod lanes;
mod names;

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;

use proc_macro2::TokenStream;
use quote::format_ident;
use syn::Ident;

use super::derived::Kind;
use super::graph::{Graph, Node, Operation, before_the_run};
use expression::{Writer, partner};
pub use inlined::{inlined, inlined_on_lanes};
use names::Names;

/// How deep an expression is nested before a part of it becomes a `let`: a sum of thousands of terms is as
/// many additions deep.
const DEEPEST: u32 = 64;

/// Straight-line code: statements, then one expression for each output.
pub struct StraightLine {
    pub statements: TokenStream,
    /// Statements that read the late parameters of [`Kind::Lanes`]; none in other code.
    pub later: TokenStream,
    pub outputs: Vec<TokenStream>,
    /// Whether q occurs.
    pub uses_coordinates: bool,
    /// Whether v occurs.
    pub uses_velocities: bool,
    /// Whether u occurs.
    pub uses_inputs: bool,
    /// Whether one of the runtime's elementary functions is called.
    pub calls_elementary: bool,
    /// Names of the runtime that are written.
    pub names: BTreeSet<&'static str>,
    /// Values that code on members has from before it runs.
    pub fields: Vec<Field>,
    /// Whether code on members reads curves of their systems.
    pub reads_systems: bool,
    /// How many angles and reciprocals start from those of the sweep before.
    pub anchors: [usize; 2],
    /// The first word of each parameter that occurs.
    parameters: Vec<String>,
}

/// Something that code on members has from before it runs: what is made of fields alone, or what other code
/// on members hands over.
#[derive(Clone)]
pub struct Field {
    pub node: Node,
    /// The local that holds it.
    pub name: Ident,
    /// Whether it is a truth value, not a number.
    pub is_truth: bool,
}

impl StraightLine {
    /// Whether a parameter or a member of it occurs.
    pub fn uses(&self, parameter: &str) -> bool {
        self.parameters.iter().any(|word| word == parameter)
    }
}

/// A graph to be written as text: in whose numbers, and beside which names.
#[derive(Clone, Copy)]
pub struct Writing<'t> {
    pub graph: &'t Graph,
    pub scalar: &'t Ident,
    /// Names that are not given to anything.
    pub taken: &'t [&'t str],
    /// Whether elementary functions are the runtime's.
    pub is_portable: bool,
}

impl Writing<'_> {
    /// The code for `outputs`. q, v and u are read as `q[0]`, `v[0]`, `u[0]`.
    pub fn numbers(self, outputs: &[Node]) -> StraightLine {
        self.written(outputs, &Kind::Numbers)
    }

    /// [`numbers`](Self::numbers) of another kind.
    pub fn written(self, outputs: &[Node], kind: &Kind) -> StraightLine {
        let Writing { graph, scalar, taken, is_portable } = self;
        let is_dual = matches!(kind, Kind::Duals);
        let (late, lanes) = match kind {
            Kind::Lanes { late, .. } => (Some(&late[..]), number_of_stages(graph)),
            Kind::Members { .. } => (Some(&[][..]), number_of_members(graph)),
            Kind::Numbers | Kind::NumbersAsMembers | Kind::Duals => (None, number_of_stages(graph)),
        };
        let mut nodes = graph.reachable(outputs.iter().copied());
        let (is_constant, reads) = before_the_run(graph, &nodes, taken);
        let is_known: Vec<bool> = match kind {
            Kind::Members { handed, .. } => {
                let is_field = |node: &Node| is_constant[node.index()] && reads[node.index()];
                graph.nodes().map(|node| is_field(&node) || handed.contains(&node)).collect()
            }
            _ => vec![false; graph.len()],
        };
        if matches!(kind, Kind::Members { .. }) {
            nodes = graph.reachable_before(outputs.iter().copied(), |node| is_known[node.index()]);
        }
        let mut uses = vec![0_u32; graph.len()];
        for &node in nodes.iter().filter(|node| !is_known[node.index()]) {
            for argument in graph.operation(node).arguments() {
                uses[argument.index()] += 1;
            }
        }
        for output in outputs {
            uses[output.index()] += 1;
        }
        let mut writer = Writer {
            graph,
            scalar,
            locals: vec![None; graph.len()],
            names: Names::new(graph, taken),
            typed: vec![false; graph.len()],
            is_portable,
            calls_elementary: Cell::new(false),
            is_lanes: vec![false; graph.len()],
            lanes: if matches!(kind, Kind::Members { .. }) { "Members" } else { "Lanes" },
            runtime: RefCell::default(),
            stages: lanes,
            is_dual,
            anchored: match kind {
                Kind::Lanes { reciprocals, .. } | Kind::Members { reciprocals: Some(reciprocals), .. } => {
                    Some(&reciprocals[..])
                }
                _ => None,
            },
            anchors: [0; 2],
            is_branch_free: match kind {
                Kind::NumbersAsMembers => is_constant.iter().map(|is_constant| !is_constant).collect(),
                _ => vec![false; graph.len()],
            },
            is_condition: conditions(graph, &nodes),
        };
        // Vectors that functions on members are handed: their entries are numbers of members.
        let is_of_members = |operation: Operation| matches!((kind, operation), (Kind::Members { .. }, Operation::Parameter(index)) if graph.parameter(index).is_entry());
        let mut receives = vec![false; graph.len()];
        for receiver in nodes.iter().filter_map(|&node| graph.operation(node).receiver()) {
            receives[receiver.index()] = true;
        }
        let mut is_late = vec![false; graph.len()];
        let mut depths = vec![0_u32; graph.len()];
        let (mut statements, mut later) = (TokenStream::new(), TokenStream::new());
        let (mut uses_coordinates, mut uses_velocities, mut uses_inputs) = (false, false, false);
        let mut parameters = Vec::new();
        let (mut fields, mut reads_systems) = (Vec::new(), false);
        for &node in nodes.iter().filter(|node| is_known[node.index()]) {
            let name = writer.names.of(graph, node, &writer.locals);
            writer.locals[node.index()] = Some(name.clone());
            writer.is_lanes[node.index()] = true;
            let is_truth = writer.is_condition[node.index()] || graph.operation(node).is_truth();
            fields.push(Field { node, name, is_truth });
        }
        for &node in nodes.iter().filter(|node| !is_known[node.index()]) {
            let operation = graph.operation(node);
            writer.typed[node.index()] = match operation {
                Operation::Constant(_) => is_dual,
                Operation::Coordinate(_)
                | Operation::Velocity(_)
                | Operation::Input(_)
                | Operation::Parameter(_) => true,
                Operation::Select(_, a, b) => writer.typed[a.index()] || writer.typed[b.index()],
                Operation::Characteristic(..) => true,
                operation if operation.receiver().is_some() => true,
                operation => operation.arguments().any(|argument| writer.typed[argument.index()]),
            };
            let is_of_each_member =
                matches!(operation, Operation::Characteristic(curve, _) if writer.is_of_each_member(curve));
            reads_systems |= is_of_each_member;
            if let Some(late) = late {
                is_late[node.index()] =
                    late.contains(&node) || operation.arguments().any(|argument| is_late[argument.index()]);
                // Inputs and what derivatives are taken by on request are numbers.
                writer.is_lanes[node.index()] |= is_late[node.index()]
                    || matches!(operation, Operation::Coordinate(_) | Operation::Velocity(_))
                    || graph.is_time(operation)
                    || is_of_members(operation)
                    || is_of_each_member
                    || operation.arguments().any(|argument| writer.is_lanes[argument.index()]);
            }
            match operation {
                Operation::Coordinate(_) => uses_coordinates = true,
                Operation::Velocity(_) => uses_velocities = true,
                Operation::Input(_) => uses_inputs = true,
                Operation::Parameter(index) => {
                    parameters.extend(
                        graph.parameter(index).tokens.clone().into_iter().next().map(|word| word.to_string()),
                    );
                }
                _ => {}
            }
            let is_leaf = match operation {
                // A local already.
                Operation::Parameter(index) => graph.parameter(index).is_in_place(),
                operation => operation.is_literal(),
            };
            let is_paired = partner(graph, node, &nodes).is_some();
            // `(1.5 + 0.5).ln()` has no type: a local says it.
            let needs_type = receives[node.index()] && !writer.typed[node.index()];
            let is_single = !is_paired
                && writer.anchor(node).is_none()
                && !needs_type
                && uses[node.index()] <= 1
                && !matches!(operation, Operation::Select(..) | Operation::Characteristic(..))
                && !matches!(operation, Operation::Parameter(index) if graph.parameter(index).is_apart())
                && (graph.name(node).is_none() || matches!(operation, Operation::Parameter(_)));
            let depth = operation.arguments().map(|argument| depths[argument.index()] + 1).max().unwrap_or(0);
            if is_leaf || (is_single && depth < DEEPEST) || writer.locals[node.index()].is_some() {
                depths[node.index()] = if is_leaf || is_single { depth } else { 0 };
                continue;
            }
            let statement = writer.statement(node, &nodes);
            if is_late[node.index()] { later.extend(statement) } else { statements.extend(statement) }
        }
        let outputs = outputs
            .iter()
            .map(|&node| if late.is_some() { writer.lanes(node) } else { writer.expression(node).tokens })
            .collect();
        let calls_elementary = writer.calls_elementary.get();
        StraightLine {
            statements,
            later,
            outputs,
            uses_coordinates,
            uses_velocities,
            uses_inputs,
            calls_elementary,
            names: writer.runtime.into_inner(),
            fields,
            reads_systems,
            anchors: writer.anchors,
            parameters,
        }
    }
}

/// Which expressions stand as conditions.
fn conditions(graph: &Graph, nodes: &[Node]) -> Vec<bool> {
    let mut is_condition = vec![false; graph.len()];
    for &node in nodes {
        match graph.operation(node) {
            Operation::Select(condition, ..) | Operation::Not(condition) => {
                is_condition[condition.index()] = true;
            }
            Operation::And(a, b) | Operation::Or(a, b) => {
                is_condition[a.index()] = true;
                is_condition[b.index()] = true;
            }
            _ => {}
        }
    }
    is_condition
}

/// The name of the number of stages: not that of a constant of the user's, nor the system's.
pub fn number_of_stages(graph: &Graph) -> Ident {
    number_named("S", graph)
}

/// The name of the number of members.
pub fn number_of_members(graph: &Graph) -> Ident {
    number_named("W", graph)
}

fn number_named(name: &str, graph: &Graph) -> Ident {
    let mut name = name.to_owned();
    while graph.mentions(&name) || graph.is_reserved(&name) {
        name.push('_');
    }
    format_ident!("{name}")
}
