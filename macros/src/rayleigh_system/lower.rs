//! From the bodies of L, R and f, as the user wrote them, to expressions of a graph.
//!
//! The body is run over symbolic numbers: helpers and closures are called, loops over known ranges run,
//! integers are computed. What depends on a comparison of numbers runs both ways, and every local that
//! differs becomes a selection. What cannot be run is refused with its token and a reason; the caller decides
//! whether that is an error.

mod access;
mod call;
mod characteristic;
mod choice;
mod class;
mod conversion;
mod expression;
mod field;
mod integer;
mod labelled;
mod load;
mod method;
mod module;
mod mutable;
mod operator;
mod pattern;
mod place;
mod refusal;
mod rounding;
mod selection;
mod sequence;
mod shape;
mod size;
mod statement;
mod value;
mod written;

use std::collections::{BTreeMap, HashMap};

use proc_macro2::{Span, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::Ident;

use super::graph::{Graph, Node, Operation};
use super::model::{Source, System};
use super::parts::{Part, Returns};
use class::Classes;
pub use load::{Length, Load};
pub use refusal::Refusal;
use refusal::{Result, refuse};
use value::Value;
use written::{Clash, Text, Written};

/// Bodies beyond this are left to num-dual.
pub const MAX_NODES: usize = super::graph::MOST_OPERATIONS;

/// Statements and expressions run before a body is given up: an unrolled loop may be long, but not endless.
const MAX_EVALUATIONS: usize = 400_000;

/// Expressions that are run one within the other, in all bodies that are being run: as many fit the stack.
const MAX_NESTING: usize = 6_500;

/// L, R and f as expressions.
pub struct Lowered {
    pub graph: Graph,
    pub n: usize,
    /// Entries of the input.
    pub m: usize,
    pub lagrangian: Node,
    pub rayleigh: Option<Node>,
    pub force: Option<Vec<Node>>,
    /// σ, the time scale.
    pub time_scale: Option<Node>,
    /// The constraints and the velocity constraints, one by one.
    pub constraints: [Vec<Node>; 2],
    /// The functions of the block that were run.
    pub functions: Vec<Ident>,
    /// Methods taken for those of slices, each called on an array of so many numbers: rustc has to agree.
    pub of_arrays: Vec<(Ident, usize)>,
    /// Names taken for bindings where a constant of that name would be one: rustc has to agree.
    pub bindings: Vec<Ident>,
    /// The loop or method call that writes most operations.
    pub heaviest: Option<Load>,
    /// The names of the methods that gave numbers, where each stands first, in R if it stands there.
    pub methods: HashMap<Node, Span>,
}

/// L, R and f of the system, or the first token that cannot be lowered.
pub fn system(system: &System<'_>) -> Result<Lowered> {
    let lowered = on_graph(system, Graph::default())?;
    if lowered.graph.shows_zeros_left_out() { on_graph(system, Graph::with_zeros()) } else { Ok(lowered) }
}

fn on_graph(system: &System<'_>, graph: Graph) -> Result<Lowered> {
    let mut lowering = Lowering {
        source: system.source,
        scalar: system.scalar.clone(),
        graph,
        locals: Vec::new(),
        captured: 0,
        returned: Returned::Never,
        leaving: None,
        labels: Vec::new(),
        guards: Vec::new(),
        depth: 0,
        evaluations: 0,
        nesting: 0,
        integers: Classes::default(),
        bindings: BTreeMap::new(),
        heaviest: None,
        is_weighed: false,
        part: None,
        functions: Vec::new(),
        of_arrays: Vec::new(),
        methods: HashMap::new(),
    };
    lowering.graph.reserve(system.name.to_string());
    // Known before the bodies read them.
    for parameter in &system.parameters {
        lowering.graph.listed(parameter);
    }
    let n = lowering.length(&system.degrees.length)?;
    let coordinates = (0..n).map(|i| Value::Real(lowering.graph.node(Operation::Coordinate(i)))).collect();
    let velocities = (0..n).map(|i| Value::Real(lowering.graph.node(Operation::Velocity(i)))).collect();
    let (q, v) = (Value::Sequence(coordinates), Value::Sequence(velocities));
    let m = match &system.input {
        None => 0,
        Some(input) => lowering.length(&input.length)?,
    };
    let u = system.input.as_ref().map(|_| {
        Value::Sequence((0..m).map(|i| Value::Real(lowering.graph.node(Operation::Input(i)))).collect())
    });
    // A local of the generated function. Constraints that move are differentiated by it.
    let is_variable = Part::CONSTRAINTS.into_iter().any(|part| system.takes_time(part));
    let t = system.is_timed().then(|| Value::Real(lowering.graph.time(is_variable)));

    let mut values = [const { None }; Part::ALL.len()];
    match system.source {
        Source::Block(_) => {
            let all = [Some(q), Some(v), u, t];
            for (part, value) in Part::ALL.into_iter().zip(&mut values) {
                let Some(takes) = system.takes(part).filter(|_| part.entry().is_differentiated) else {
                    continue;
                };
                let arguments = takes.choose(all.clone()).flatten().collect();
                if part == Part::Rayleigh {
                    lowering.methods.clear();
                }
                *value = Some(lowering.root(part.name(), arguments)?);
            }
        }
        Source::Function(function) => {
            let fields = function.fields().map(|(name, _)| Value::Written(Written::leaf(quote!(self.#name))));
            let arguments = [q, v].into_iter().chain(fields).collect();
            let signature = &function.item.sig;
            let result = lowering.call(&signature.ident, signature, &function.item.block, arguments)?;
            match result {
                Value::Tuple(pair) if system.has(Part::Rayleigh) && pair.len() == 2 => {
                    values.iter_mut().zip(pair).for_each(|(value, of_pair)| *value = Some(of_pair));
                }
                result => values[Part::Lagrangian as usize] = Some(result),
            }
        }
    }
    let at = &system.name;
    let mut roots = [const { None }; Part::ALL.len()];
    for (part, (value, roots)) in Part::ALL.into_iter().zip(values.into_iter().zip(&mut roots)) {
        let Some(value) = value else { continue };
        let components = match (part.entry().returns, value) {
            (Returns::Number, number) => vec![number],
            (Returns::Covector | Returns::Numbers, Value::Sequence(components)) => components,
            (Returns::Covector, _) => {
                return refuse(at, "the force is not an array whose entries can be told apart");
            }
            (Returns::Numbers, _) => {
                return refuse(at, "the constraints are not an array whose entries can be told apart");
            }
        };
        let components = components.into_iter().map(|component| lowering.scalar(at, component));
        *roots = Some(components.collect::<Result<Vec<_>>>()?);
    }
    let [lagrangian, rayleigh, force, time_scale, constraints, velocity_constraints, ..] = roots;
    let number = |roots: Option<Vec<Node>>| roots.and_then(|roots| roots.first().copied());
    let Some(lagrangian) = number(lagrangian) else {
        return refuse(at, "there is no Lagrangian");
    };
    lowering.integers.settled()?;
    let bindings = lowering.bindings.into_values().collect();
    let (functions, of_arrays, heaviest) = (lowering.functions, lowering.of_arrays, lowering.heaviest);
    Ok(Lowered {
        graph: lowering.graph,
        n,
        m,
        lagrangian,
        rayleigh: number(rayleigh),
        force,
        time_scale: number(time_scale),
        constraints: [constraints, velocity_constraints].map(Option::unwrap_or_default),
        functions,
        of_arrays,
        bindings,
        heaviest,
        methods: lowering.methods,
    })
}

/// Whether the function has returned.
#[derive(Clone)]
enum Returned {
    Never,
    /// Where the condition holds.
    Where(Node, Value),
    Always(Value),
}

/// `break` or `continue` on its way to a loop.
#[derive(Clone)]
struct Leaving {
    is_break: bool,
    label: Option<String>,
    value: Value,
}

/// The state of one symbolic run of a body.
struct Lowering<'s> {
    source: &'s Source,
    /// `f64` or `f32`.
    scalar: Ident,
    graph: Graph,
    /// Innermost last; a later one of the same name hides the earlier.
    locals: Vec<(String, Value)>,
    /// Locals before this index belong to the surroundings of a closure: it can read, but not change them.
    captured: usize,
    returned: Returned,
    leaving: Option<Leaving>,
    /// Blocks that are run as bodies, innermost last.
    labels: Vec<String>,
    /// Conditions, and which way they were decided, under which the code being run is reached.
    guards: Vec<(Node, bool)>,
    depth: usize,
    evaluations: usize,
    /// Expressions that are being run, one within the other.
    nesting: usize,
    integers: Classes,
    bindings: BTreeMap<String, Ident>,
    functions: Vec<Ident>,
    /// Methods of slices, with the length of the array of numbers that each was called on.
    of_arrays: Vec<(Ident, usize)>,
    heaviest: Option<Load>,
    methods: HashMap<Node, Span>,
    /// Whether a loop or call is running whose operations are counted.
    is_weighed: bool,
    /// The function being run, as it was called from outside.
    part: Option<Ident>,
}

impl Lowering<'_> {
    fn root(&mut self, name: &str, arguments: Vec<Value>) -> Result<Value> {
        let Some(function) = self.function(&format_ident!("{name}")).cloned() else {
            return refuse(&self.source.name(), format!("`{name}` is missing"));
        };
        self.call(&function.sig.ident, &function.sig, &function.block, arguments)
    }

    /// The expression as it is written out.
    fn text(&mut self, at: &impl ToTokens, written: &Written) -> Result<Text> {
        written.text().or_else(|Clash(name)| {
            refuse(
                at,
                format!("two patterns bind `{name}`, and this needs both; give one of them another name"),
            )
        })
    }

    fn local(&self, name: &Ident) -> Option<&Value> {
        let name = name.to_string();
        self.locals.iter().rev().find(|(known, _)| *known == name).map(|(_, value)| value)
    }

    fn is_too_long(&self) -> bool {
        self.evaluations > MAX_EVALUATIONS || self.graph.len() > MAX_NODES
    }

    /// Counts work, so that no loop runs without end.
    fn count(&mut self, at: &impl ToTokens) -> Result<()> {
        self.evaluations += 1;
        if self.is_too_long() {
            return refuse(at, "the loops, written out, are too long for straight-line code");
        }
        Ok(())
    }
}

/// The tokens of a field with an index or member behind it.
fn indexed(base: &TokenStream, index: usize) -> TokenStream {
    let index = syn::Index::from(index);
    quote!(#base[#index])
}
