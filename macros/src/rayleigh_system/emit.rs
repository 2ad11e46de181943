//! From expressions to straight-line code that reads as if written by hand.
//!
//! What is used more than once, what the user named, and every selection becomes a `let`; the rest stands
//! where it is used. Only what the outputs need is written, in the order in which it was found, so that equal
//! systems give equal text.
//!
//! The same text serves numbers and lanes, but for selections: what differs is in `lanes.rs`.

mod lanes;
mod names;

use std::cell::Cell;

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use syn::Ident;

use super::graph::{Comparison, Function, Graph, Node, Operation};
use super::portable;
use names::Names;

/// How deep an expression is nested before a part of it becomes a `let`: a sum of thousands of terms is as
/// many additions deep.
const DEEPEST: u32 = 64;

/// Straight-line code: statements, then one expression for each output.
pub struct StraightLine {
    pub statements: TokenStream,
    /// Those that need the values that come later, of code in lanes.
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
    /// The first word of each parameter that occurs.
    parameters: Vec<String>,
}

impl StraightLine {
    /// Whether a parameter or a member of it occurs.
    pub fn uses(&self, parameter: &str) -> bool {
        self.parameters.iter().any(|word| word == parameter)
    }
}

/// The code for `outputs`. q, v and u are read as `q[0]`, `v[0]`, `u[0]`; the names `taken` are not given to
/// anything.
///
/// `is_portable`: elementary functions are the runtime's.
pub fn straight_line(
    graph: &Graph,
    scalar: &Ident,
    outputs: &[Node],
    taken: &[&str],
    is_portable: bool,
) -> StraightLine {
    written(graph, scalar, outputs, taken, is_portable, Kind::Numbers)
}

/// The code for `outputs` over `Real<D>`, q, v, u and the time being such numbers; fields and constants are
/// lifted.
pub fn over_duals(graph: &Graph, scalar: &Ident, outputs: &[Node], taken: &[&str]) -> StraightLine {
    written(graph, scalar, outputs, taken, false, Kind::Duals)
}

/// What the code computes with.
#[derive(Clone, Copy)]
enum Kind<'l> {
    Numbers,
    /// Lanes, some of them late.
    Lanes(&'l [Node]),
    Duals,
}

/// The code for `outputs` where q, v and the time are lanes. The parameters `late` are lanes as well, and
/// known only after the statements that do not need them.
pub fn in_lanes(
    graph: &Graph,
    scalar: &Ident,
    outputs: &[Node],
    taken: &[&str],
    is_portable: bool,
    late: &[Node],
) -> StraightLine {
    written(graph, scalar, outputs, taken, is_portable, Kind::Lanes(late))
}

fn written(
    graph: &Graph,
    scalar: &Ident,
    outputs: &[Node],
    taken: &[&str],
    is_portable: bool,
    kind: Kind<'_>,
) -> StraightLine {
    let late = if let Kind::Lanes(late) = kind { Some(late) } else { None };
    let is_dual = matches!(kind, Kind::Duals);
    let nodes = graph.reachable(outputs.iter().copied());
    let mut uses = vec![0_u32; graph.len()];
    for &node in &nodes {
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
        names: Names::new(taken),
        typed: vec![false; graph.len()],
        is_portable,
        calls_elementary: Cell::new(false),
        is_lanes: vec![false; graph.len()],
        stages: number_of_stages(graph),
        is_dual,
        is_condition: conditions(graph, &nodes),
    };
    let mut receives = vec![false; graph.len()];
    for receiver in nodes.iter().filter_map(|&node| graph.operation(node).receiver()) {
        receives[receiver.index()] = true;
    }
    let mut is_late = vec![false; graph.len()];
    let mut depths = vec![0_u32; graph.len()];
    let (mut statements, mut later) = (TokenStream::new(), TokenStream::new());
    let (mut uses_coordinates, mut uses_velocities, mut uses_inputs) = (false, false, false);
    let mut parameters = Vec::new();
    for &node in &nodes {
        let operation = graph.operation(node);
        writer.typed[node.index()] = match operation {
            Operation::Constant(_) => is_dual,
            Operation::Coordinate(_)
            | Operation::Velocity(_)
            | Operation::Input(_)
            | Operation::Parameter(_) => true,
            Operation::Select(_, a, b) => writer.typed[a.index()] || writer.typed[b.index()],
            operation if operation.receiver().is_some() => true,
            operation => operation.arguments().any(|argument| writer.typed[argument.index()]),
        };
        if let Some(late) = late {
            is_late[node.index()] =
                late.contains(&node) || operation.arguments().any(|argument| is_late[argument.index()]);
            // Inputs and what derivatives are taken by on request are numbers.
            writer.is_lanes[node.index()] = is_late[node.index()]
                || matches!(operation, Operation::Coordinate(_) | Operation::Velocity(_))
                || graph.is_time(operation)
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
            && !needs_type
            && uses[node.index()] <= 1
            && !matches!(operation, Operation::Select(..))
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
        parameters,
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

/// The name of the number of lanes: not that of a constant of the user's, nor the system's.
pub fn number_of_stages(graph: &Graph) -> Ident {
    let mut name = "S".to_owned();
    while graph.mentions(&name) || graph.is_reserved(&name) {
        name.push('_');
    }
    format_ident!("{name}")
}

/// The cosine of the angle that `node` is the sine of, or the other way about, if it comes later; and the
/// angle.
fn partner(graph: &Graph, node: Node, nodes: &[Node]) -> Option<(Node, Node)> {
    let (other, angle) = match graph.operation(node) {
        Operation::Function(Function::Sin, angle) => (Function::Cos, angle),
        Operation::Function(Function::Cos, angle) => (Function::Sin, angle),
        _ => return None,
    };
    let partner = graph.known(Operation::Function(other, angle))?;
    (partner > node && nodes.binary_search(&partner).is_ok()).then_some((partner, angle))
}

/// How tightly an expression holds together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Or,
    And,
    Comparison,
    Sum,
    Product,
    Sign,
    Atom,
}

struct Written {
    tokens: TokenStream,
    binding: Binding,
    /// Whether it begins with a sign, and cannot take another.
    is_signed: bool,
}

impl Written {
    fn new(tokens: TokenStream, binding: Binding) -> Self {
        Self { tokens, binding, is_signed: binding == Binding::Sign }
    }

    /// The tokens as an operand of something that binds as tightly as `binding`.
    fn within(self, binding: Binding) -> TokenStream {
        let tokens = self.tokens;
        if self.binding < binding { quote!((#tokens)) } else { tokens }
    }
}

struct Writer<'g> {
    graph: &'g Graph,
    scalar: &'g Ident,
    /// The local that holds a node.
    locals: Vec<Option<Ident>>,
    names: Names,
    /// Whether the type shows: an expression of literals alone has none of its own.
    typed: Vec<bool>,
    is_portable: bool,
    calls_elementary: Cell<bool>,
    /// Whether the value is lanes; nothing is in code on numbers.
    is_lanes: Vec<bool>,
    /// The number of lanes.
    stages: Ident,
    /// Whether numbers are `Real<D>`.
    is_dual: bool,
    /// Which fields are truth values.
    is_condition: Vec<bool>,
}

impl Writer<'_> {
    /// `let s = …;`
    fn statement(&mut self, node: Node, nodes: &[Node]) -> TokenStream {
        // Sine and cosine of one angle are one call.
        if let Some((partner, angle)) = partner(self.graph, node, nodes) {
            let argument = self.called_on(angle, "sin_cos");
            let [own, its] = [node, partner].map(|node| {
                let name = self.names.of(self.graph, node, &self.locals);
                self.locals[node.index()] = Some(name.clone());
                name
            });
            let is_sine = matches!(self.graph.operation(node), Operation::Function(Function::Sin, _));
            let (sine, cosine) = if is_sine { (own, its) } else { (its, own) };
            return quote!(let (#sine, #cosine) = #argument.sin_cos(););
        }
        let value = self.expression(node).tokens;
        let name = self.names.of(self.graph, node, &self.locals);
        self.locals[node.index()] = Some(name.clone());
        let is_lanes = self.is_lanes[node.index()];
        if is_lanes || self.typed[node.index()] || self.graph.operation(node).is_truth() {
            return quote!(let #name = #value;);
        }
        let scalar = self.scalar;
        self.typed[node.index()] = true;
        quote!(let #name: #scalar = #value;)
    }

    fn expression(&self, node: Node) -> Written {
        if let Some(name) = &self.locals[node.index()] {
            return Written::new(quote!(#name), Binding::Atom);
        }
        let binary = |a: Node, symbol: TokenStream, b: Node, left: Binding, right: Binding| {
            let (a, b) = (self.expression(a).within(left), self.expression(b).within(right));
            quote!(#a #symbol #b)
        };
        if self.is_lanes[node.index()]
            && let Some(written) = self.operation_on_lanes(node)
        {
            return written;
        }
        let (tokens, binding) = match self.graph.operation(node) {
            Operation::Coordinate(index) => {
                let index = Literal::usize_unsuffixed(index);
                (quote!(q[#index]), Binding::Atom)
            }
            Operation::Velocity(index) => {
                let index = Literal::usize_unsuffixed(index);
                (quote!(v[#index]), Binding::Atom)
            }
            Operation::Input(index) => {
                let index = Literal::usize_unsuffixed(index);
                (quote!(u[#index]), Binding::Atom)
            }
            operation @ Operation::Parameter(index) => {
                let operand = self.graph.parameter(index).operand();
                let is_lifted =
                    self.is_dual && !self.is_condition[node.index()] && !self.graph.is_time(operation);
                (if is_lifted { quote!(D::lift(#operand)) } else { operand }, Binding::Atom)
            }
            Operation::Constant(bits) => self.constant(f64::from_bits(bits), false),
            Operation::Add(a, b) => return self.nested(a, quote!(+), b, Binding::Sum),
            Operation::Subtract(a, b) => {
                (binary(a, quote!(-), b, Binding::Sum, Binding::Product), Binding::Sum)
            }
            Operation::Multiply(a, b) => {
                // What changes least in front: `2.0 * x`, `k * v[0]`.
                let (a, b) = if self.changes(b) < self.changes(a) { (b, a) } else { (a, b) };
                return self.nested(a, quote!(*), b, Binding::Product);
            }
            Operation::Divide(a, b) => {
                (binary(a, quote!(/), b, Binding::Product, Binding::Sign), Binding::Product)
            }
            Operation::Negate(a) => return self.negated(a),
            Operation::Function(function, x) => {
                let (x, name) = (self.called_on(x, function.name()), format_ident!("{}", function.name()));
                (quote!(#x.#name()), Binding::Atom)
            }
            Operation::Pair(function, a, b) => {
                let (a, name) = (self.called_on(a, function.name()), format_ident!("{}", function.name()));
                let b = self.expression(b).tokens;
                (quote!(#a.#name(#b)), Binding::Atom)
            }
            Operation::Power(x, n) => {
                let (x, n) = (self.called_on(x, "powi"), Literal::i32_unsuffixed(n));
                (quote!(#x.powi(#n)), Binding::Atom)
            }
            Operation::MultiplyAdd(a, b, c) => {
                let a = self.called_on(a, "mul_add");
                let (b, c) = (self.expression(b).tokens, self.expression(c).tokens);
                (quote!(#a.mul_add(#b, #c)), Binding::Atom)
            }
            Operation::Select(condition, a, b) => {
                let condition = self.expression(condition).tokens;
                let (a, b) = (self.expression(a).tokens, self.expression(b).tokens);
                (quote!(if #condition { #a } else { #b }), Binding::Or)
            }
            Operation::Compare(comparison, a, b) => {
                let symbol = match comparison {
                    Comparison::Less => quote!(<),
                    Comparison::LessOrEqual => quote!(<=),
                    Comparison::Greater => quote!(>),
                    Comparison::GreaterOrEqual => quote!(>=),
                    Comparison::Equal => quote!(==),
                    Comparison::NotEqual => quote!(!=),
                };
                (binary(a, symbol, b, Binding::Sum, Binding::Sum), Binding::Comparison)
            }
            Operation::Is(predicate, x) => {
                let (x, name) = (self.receiver(x), format_ident!("{}", predicate.name()));
                (quote!(#x.#name()), Binding::Atom)
            }
            Operation::Not(a) => {
                let a = self.expression(a).within(Binding::Atom);
                (quote!(!#a), Binding::Sign)
            }
            Operation::And(a, b) => {
                (binary(a, quote!(&&), b, Binding::And, Binding::Comparison), Binding::And)
            }
            Operation::Or(a, b) => {
                // Mixed `&&` and `||` in parentheses, as one reads them.
                let operand = |node| {
                    let written = self.expression(node);
                    if written.binding == Binding::And {
                        written.within(Binding::Atom)
                    } else {
                        written.tokens
                    }
                };
                let (a, b) = (operand(a), operand(b));
                (quote!(#a || #b), Binding::Or)
            }
        };
        Written::new(tokens, binding)
    }

    /// A sum or product of the kind of `binding`, nested to the left: a + b + x for x + (a + b). The two are
    /// equal to the last bit; not so the derivatives of dual numbers.
    fn nested(&self, a: Node, symbol: TokenStream, b: Node, binding: Binding) -> Written {
        let (mut first, mut second) = (self.expression(a), self.expression(b));
        let may_follow = match binding {
            // Computed later, a product of locals would keep them in registers for longer.
            Binding::Sum => first.binding == Binding::Atom || self.is_of_variables(a),
            _ => first.binding > binding && !first.is_signed && self.graph.constant_value(a).is_none(),
        };
        if !self.is_dual && second.binding == binding && may_follow {
            (first, second) = (second, first);
        }
        let is_signed = first.is_signed && first.binding >= binding;
        let tighter = if binding == Binding::Sum { Binding::Product } else { Binding::Sign };
        let (first, second) = (first.within(binding), second.within(tighter));
        Written { tokens: quote!(#first #symbol #second), binding, is_signed }
    }

    /// Whether it is a product of q, v, u and numbers alone.
    fn is_of_variables(&self, node: Node) -> bool {
        match self.graph.operation(node) {
            Operation::Multiply(a, b) if self.locals[node.index()].is_none() => {
                self.is_of_variables(a) && self.is_of_variables(b)
            }
            operation => operation.is_literal(),
        }
    }

    /// 0 for a constant, 1 for what q, v and u leave as it is, 2 for the rest. Factors of dual numbers keep
    /// their order, but for constants.
    fn changes(&self, factor: Node) -> u8 {
        match self.graph.constant_value(factor) {
            Some(_) => 0,
            None if self.is_dual => 1,
            None => 1 + u8::from(self.graph.depends(factor)),
        }
    }

    /// −a, the sign at the first factor of a product.
    fn negated(&self, a: Node) -> Written {
        let a = self.expression(a);
        if a.binding == Binding::Product && !a.is_signed && !self.is_dual {
            let tokens = a.tokens;
            return Written { tokens: quote!(-#tokens), binding: Binding::Product, is_signed: true };
        }
        let a = a.within(Binding::Atom);
        Written::new(quote!(-#a), Binding::Sign)
    }

    /// What the method of that name is called on: the number, or its elementary functions in the runtime.
    fn called_on(&self, node: Node, method: &str) -> TokenStream {
        let receiver = self.receiver(node);
        // Lanes bring their own.
        let is_number = !self.is_lanes[node.index()];
        if is_number && self.is_portable && portable::is_elementary(method) {
            self.calls_elementary.set(true);
            quote!(#receiver.elementary())
        } else {
            receiver
        }
    }

    /// What a method is called on.
    fn receiver(&self, node: Node) -> TokenStream {
        match self.graph.constant_value(node) {
            Some(value) => {
                let (tokens, binding) = self.constant(value, true);
                Written::new(tokens, binding).within(Binding::Atom)
            }
            None => self.expression(node).within(Binding::Atom),
        }
    }

    /// A number. Among other literals alone, or as a receiver, it has to say its type.
    fn constant(&self, value: f64, suffixed: bool) -> (TokenStream, Binding) {
        use std::f64::consts::{LN_2, LOG2_E, LOG10_E};
        let size = value.abs();
        let named = [(LN_2, "LN_2"), (LOG2_E, "LOG2_E"), (LOG10_E, "LOG10_E")];
        let literal = if let Some((_, name)) = named.iter().find(|(constant, _)| *constant == size) {
            let (scalar, name) = (self.scalar, format_ident!("{name}"));
            quote!(::core::#scalar::consts::#name)
        } else if !size.is_finite() {
            // What constants overflow to, or leave undefined.
            let (scalar, name) = (self.scalar, if size.is_nan() { "NAN" } else { "INFINITY" });
            let name = format_ident!("{name}");
            quote!(::core::primitive::#scalar::#name)
        } else if suffixed {
            let text = format!("{size:?}_{}", self.scalar);
            text.parse().unwrap_or_else(|_| quote!(#size))
        } else {
            let literal = Literal::f64_unsuffixed(size);
            quote!(#literal)
        };
        let is_negative = value.is_sign_negative();
        if self.is_dual {
            let sign = is_negative.then(|| quote!(-));
            return (quote!(D::real(#sign #literal)), Binding::Atom);
        }
        if is_negative { (quote!(-#literal), Binding::Sign) } else { (literal, Binding::Atom) }
    }
}
