//! Expressions and the statements that name them, in as few brackets as keep every bit.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use syn::Ident;

use super::super::functions::is_elementary;
use super::super::graph::{Function, Graph, Node, Operation};
use super::super::portable;
use super::names::Names;

/// The cosine of the angle that `node` is the sine of, or the other way about, if it comes later; and the
/// angle.
pub fn partner(graph: &Graph, node: Node, nodes: &[Node]) -> Option<(Node, Node)> {
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
pub enum Binding {
    Or,
    And,
    Comparison,
    Sum,
    Product,
    Sign,
    Atom,
}

pub struct Written {
    pub tokens: TokenStream,
    pub binding: Binding,
    /// Whether it begins with a sign, and cannot take another.
    pub is_signed: bool,
}

impl Written {
    pub fn new(tokens: TokenStream, binding: Binding) -> Self {
        Self { tokens, binding, is_signed: binding == Binding::Sign }
    }

    /// The tokens as an operand of something that binds as tightly as `binding`.
    pub fn within(self, binding: Binding) -> TokenStream {
        let tokens = self.tokens;
        if self.binding < binding { quote!((#tokens)) } else { tokens }
    }
}

/// A computation that starts from its result in the sweep before.
#[derive(Clone, Copy)]
pub enum Anchor {
    Angle(Node),
    /// Of this.
    Reciprocal(Node),
}

pub struct Writer<'g> {
    pub graph: &'g Graph,
    pub scalar: &'g Ident,
    /// The local that holds a node.
    pub locals: Vec<Option<Ident>>,
    pub names: Names,
    /// Whether the type shows: an expression of literals alone has none of its own.
    pub typed: Vec<bool>,
    pub is_portable: bool,
    pub calls_elementary: Cell<bool>,
    /// Whether the value is lanes; nothing is in code on numbers.
    pub is_lanes: Vec<bool>,
    /// The type of lanes.
    pub lanes: &'static str,
    /// Names of the runtime that are written.
    pub runtime: RefCell<BTreeSet<&'static str>>,
    /// The number of lanes.
    pub stages: Ident,
    /// Whether numbers are `Real<D>`.
    pub is_dual: bool,
    /// Which fields are truth values.
    pub is_condition: Vec<bool>,
    /// The reciprocals of sweeps, in their code.
    pub anchored: Option<&'g [Node]>,
    /// How many angles and reciprocals have been written.
    pub anchors: [usize; 2],
    /// Of which numbers sine, cosine and exponential are those of members.
    pub is_branch_free: Vec<bool>,
}

impl Writer<'_> {
    /// `let s = …;`
    pub fn statement(&mut self, node: Node, nodes: &[Node]) -> TokenStream {
        // Sine and cosine of one angle are one call.
        if let Some((partner, angle)) = partner(self.graph, node, nodes) {
            let pair = match self.anchor(node) {
                Some(anchor) => self.starting_at(anchor),
                None => {
                    let argument = self.called_on(angle, "sin_cos");
                    quote!(#argument.sin_cos())
                }
            };
            let [own, its] = [node, partner].map(|node| {
                let name = self.names.of(self.graph, node, &self.locals);
                self.locals[node.index()] = Some(name.clone());
                name
            });
            let is_sine = matches!(self.graph.operation(node), Operation::Function(Function::Sin, _));
            let (sine, cosine) = if is_sine { (own, its) } else { (its, own) };
            return quote!(let (#sine, #cosine) = #pair;);
        }
        if let Operation::Characteristic(curve, x) = self.graph.operation(node) {
            return self.characteristic(curve, x, nodes);
        }
        let value = match self.anchor(node) {
            Some(anchor) => {
                let value = self.starting_at(anchor);
                match self.graph.operation(node) {
                    Operation::Function(Function::Sin, _) => quote!(#value.0),
                    Operation::Function(..) => quote!(#value.1),
                    _ => value,
                }
            }
            None => self.expression(node).tokens,
        };
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

    /// The angle or what the reciprocal is of, where the sweep before has one to start from.
    pub fn anchor(&self, node: Node) -> Option<Anchor> {
        let reciprocals = self.anchored.filter(|_| self.is_lanes[node.index()])?;
        match self.graph.operation(node) {
            Operation::Function(Function::Sin | Function::Cos, angle) => Some(Anchor::Angle(angle)),
            Operation::Divide(_, x) if reciprocals.contains(&node) => Some(Anchor::Reciprocal(x)),
            _ => None,
        }
    }

    /// `angles[0].sin_cos(q[0])` or `reciprocals[0].of(x)`.
    fn starting_at(&mut self, anchor: Anchor) -> TokenStream {
        let [angles, reciprocals] = &mut self.anchors;
        let count = if let Anchor::Angle(_) = anchor { angles } else { reciprocals };
        let index = Literal::usize_unsuffixed(*count);
        *count += 1;
        match anchor {
            Anchor::Angle(angle) => {
                let angle = self.lanes(angle);
                quote!(angles[#index].sin_cos(#angle))
            }
            Anchor::Reciprocal(x) => {
                let x = self.lanes(x);
                quote!(reciprocals[#index].of(#x))
            }
        }
    }

    pub fn expression(&self, node: Node) -> Written {
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
                let mut operand = self.graph.parameter(index).operand();
                if self.is_portable
                    && let Some(own) = portable::text(&operand)
                {
                    self.calls_elementary.set(true);
                    operand = own;
                }
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
            Operation::Characteristic(curve, x) => (self.derivative_of(curve, x), Binding::Atom),
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
                (binary(a, comparison.symbol(), b, Binding::Sum, Binding::Sum), Binding::Comparison)
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

    /// The receiver of the method of that name: the number, or its elementary functions in the runtime.
    fn called_on(&self, node: Node, method: &str) -> TokenStream {
        let receiver = self.receiver(node);
        // Lanes bring their own.
        let is_number = !self.is_lanes[node.index()];
        if self.is_branch_free[node.index()] && ["sin", "cos", "sin_cos", "exp"].contains(&method) {
            self.calls_elementary.set(true);
            quote!(#receiver.branch_free())
        } else if is_number && self.is_portable && is_elementary(method) {
            self.calls_elementary.set(true);
            quote!(#receiver.elementary())
        } else {
            receiver
        }
    }

    /// The node as the receiver of a method.
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
