//! Fields and constants as numbers and conditions of the graph, and their methods.

use proc_macro2::Ident;
use quote::{ToTokens, format_ident, quote};
use syn::{BinOp, Expr, ExprMethodCall, UnOp, parse_quote};

use super::super::graph::{Node, Operation, Taken};
use super::operator::literal;
use super::value::{Truth, Value};
use super::written::{Text, Written};
use super::{Lowering, Result, refuse};

/// Methods that floating-point numbers share with integers, or whose constants depend on the precision: what
/// they are is left open.
const SHARED: [&str; 7] = ["abs", "clamp", "max", "min", "signum", "to_degrees", "to_radians"];

/// Methods of integers and of `Option`, written out as they stand; true where they may panic.
const WRITTEN: [(&str, bool); 43] = [
    ("pow", true),
    ("abs_diff", false),
    ("rem_euclid", true),
    ("div_euclid", true),
    ("div_ceil", true),
    ("isqrt", true),
    ("ilog2", true),
    ("ilog10", true),
    ("next_power_of_two", true),
    ("is_power_of_two", false),
    ("is_positive", false),
    ("is_negative", false),
    ("unsigned_abs", false),
    ("count_ones", false),
    ("count_zeros", false),
    ("leading_zeros", false),
    ("trailing_zeros", false),
    ("swap_bytes", false),
    ("reverse_bits", false),
    ("wrapping_add", false),
    ("wrapping_sub", false),
    ("wrapping_mul", false),
    ("wrapping_neg", false),
    ("wrapping_abs", false),
    ("wrapping_pow", false),
    ("wrapping_shl", false),
    ("wrapping_shr", false),
    ("saturating_add", false),
    ("saturating_sub", false),
    ("saturating_mul", false),
    ("saturating_pow", false),
    ("midpoint", false),
    ("is_some", false),
    ("is_none", false),
    ("is_ok", false),
    ("is_err", false),
    ("unwrap", true),
    ("unwrap_or", false),
    ("unwrap_or_default", false),
    ("copied", false),
    ("cloned", false),
    ("clone", false),
    ("as_ref", false),
];

impl Lowering<'_> {
    /// The expression as a floating-point number.
    pub fn written_scalar(&mut self, at: &impl ToTokens, written: &Written) -> Result<Node> {
        match written {
            Written::Leaf(_) => {
                let text = self.text(at, written)?;
                let node = self.text_scalar(text, written.is_bound());
                if let Some(name) = written.name() {
                    self.graph.give_name(node, &name);
                }
                Ok(node)
            }
            Written::Named(name, inner) => {
                if let Written::Leaf(_) = &**inner {
                    let text = self.text(at, inner)?;
                    let node = self.text_scalar(text, inner.is_bound());
                    self.graph.give_name(node, name);
                    return Ok(node);
                }
                let node = self.written_scalar(at, inner)?;
                self.graph.give_name(node, name);
                Ok(node)
            }
            Written::Reference(inner) => self.written_scalar(at, inner),
            Written::Unary(UnOp::Neg(_), inner) => {
                let inner = self.written_scalar(at, inner)?;
                Ok(self.graph.node(Operation::Negate(inner)))
            }
            Written::Binary(BinOp::Add(_) | BinOp::Sub(_) | BinOp::Mul(_) | BinOp::Div(_), a, b) => {
                let Written::Binary(operator, ..) = written else { return refuse(at, "not a number") };
                let (a, b) = (self.written_scalar(at, a)?, self.written_scalar(at, b)?);
                Ok(match operator {
                    BinOp::Add(_) => self.graph.add(a, b),
                    BinOp::Sub(_) => self.graph.node(Operation::Subtract(a, b)),
                    BinOp::Mul(_) => self.graph.node(Operation::Multiply(a, b)),
                    _ => self.graph.node(Operation::Divide(a, b)),
                })
            }
            Written::Method(method, receiver, arguments) => {
                let receiver = self.written_scalar(at, receiver)?;
                let arguments = arguments
                    .iter()
                    .map(|argument| self.written_scalar(at, argument).map(Value::Real))
                    .collect::<Result<_>>()?;
                let value = self.number_method(method, Value::Real(receiver), arguments)?;
                self.scalar(at, value)
            }
            // Remainders, of whatever type.
            Written::Unary(..) | Written::Binary(..) => {
                let text = self.text(at, written)?;
                Ok(self.text_scalar(text, false))
            }
        }
    }

    /// The expression as a condition.
    pub fn written_truth(&mut self, at: &impl ToTokens, written: &Written) -> Result<Node> {
        if let Written::Unary(UnOp::Not(_), inner) = written {
            let inner = self.written_truth(at, inner)?;
            return Ok(match Truth::Where(inner).not(&mut self.graph) {
                Truth::Where(node) => node,
                Truth::Known(_) => inner,
            });
        }
        let mut text = self.text(at, written)?;
        if written.is_bound() {
            let tokens = text.tokens;
            text.tokens = quote!(bool::clone(&#tokens));
        }
        Ok(self.text_truth(text))
    }

    /// Tokens that are a number, which is not evaluated where the user's code is not.
    fn text_scalar(&mut self, mut text: Text, is_bound: bool) -> Node {
        if is_bound {
            let (scalar, tokens) = (&self.scalar, text.tokens);
            text.tokens = quote!(#scalar::clone(&#tokens));
        }
        let (may_panic, is_block) = (text.may_panic, !text.arms.is_empty());
        let node = self.graph.written_as(text.within_arms(&quote!(0.0)), is_block, Taken::Number);
        match self.guard().filter(|_| may_panic) {
            Some(guard) => {
                self.graph.keep_in_place(node);
                let zero = self.graph.constant(0.0);
                self.graph.select(guard, node, zero)
            }
            None => node,
        }
    }

    /// Tokens that are a condition.
    pub fn text_truth(&mut self, text: Text) -> Node {
        let (may_panic, is_block) = (text.may_panic, !text.arms.is_empty());
        let node = self.graph.written_as(text.within_arms(&quote!(false)), is_block, Taken::Truth);
        match self.guard().filter(|_| may_panic) {
            Some(guard) => {
                self.graph.keep_in_place(node);
                self.graph.node(Operation::And(guard, node))
            }
            None => node,
        }
    }

    /// A method of a field or constant that its text says in full; nothing if it is one of numbers alone.
    pub fn written_method(
        &mut self,
        method: &Ident,
        receiver: &Written,
        arguments: &[Value],
    ) -> Result<Option<Value>> {
        let mut written = Vec::new();
        for argument in arguments {
            written.push(match argument {
                Value::Written(argument) => argument.clone(),
                Value::Integer(integer) => {
                    self.beside_field(*integer);
                    literal(*integer)
                }
                _ => return Ok(None),
            });
        }
        if SHARED.iter().any(|name| method == name) {
            return Ok(Some(Value::Written(Written::Method(
                method.clone(),
                Box::new(receiver.clone()),
                written,
            ))));
        }
        let Some((_, may_panic)) = WRITTEN.iter().find(|(name, _)| method == name) else { return Ok(None) };
        // One text within the arms of all.
        let whole = Written::Method(method.clone(), Box::new(receiver.clone()), written.clone());
        self.text(method, &whole)?;
        let mut tokens = Vec::new();
        for argument in &written {
            tokens.push(self.text(method, argument)?.tokens);
        }
        let panics =
            *may_panic || written.iter().any(|argument| argument.text().is_ok_and(|text| text.may_panic));
        let own = receiver.derived(panics, |receiver| quote!(#receiver.#method(#(#tokens),*)));
        let Written::Leaf(mut leaf) = own else { return Ok(None) };
        if let Ok(text) = whole.text() {
            leaf.arms = text.arms;
        }
        // An option is matched and asked again; what it holds may be a reference.
        leaf.is_bound = ["unwrap", "unwrap_or", "unwrap_or_default", "copied", "cloned", "clone"]
            .iter()
            .any(|name| method == name)
            && receiver.is_bound();
        Ok(Some(Value::Written(Written::Leaf(leaf))))
    }

    /// A method of an `Option` that takes a closure or a number; nothing if it is none.
    pub fn option_method(&mut self, call: &ExprMethodCall, receiver: &Written) -> Result<Option<Value>> {
        let method = &call.method;
        let arguments: Vec<&Expr> = call.args.iter().collect();
        let name = method.to_string();
        let takes = match &*name {
            "unwrap_or" | "unwrap_or_else" | "is_some_and" | "is_none_or" => 1,
            "map_or" | "map_or_else" => 2,
            _ => return Ok(None),
        };
        if arguments.len() != takes {
            return refuse(method, format!("`{method}` takes {takes} arguments"));
        }
        // `self.k.unwrap_or(0.0)` stands as it is.
        if name == "unwrap_or" && matches!(arguments[0], Expr::Lit(_)) {
            let default = arguments[0];
            let text = receiver.derived(false, |receiver| quote!(#receiver.unwrap_or(#default)));
            return Ok(Some(Value::Written(text)));
        }
        let mut values = Vec::new();
        for argument in &arguments {
            values.push(self.expression(argument)?);
        }
        let name_of_held = receiver.name().filter(|name| syn::parse_str::<Ident>(name).is_ok());
        let name_of_held = format_ident!("{}", name_of_held.unwrap_or_else(|| "held".to_owned()));
        let held: syn::Pat = parse_quote!(::core::option::Option::Some(#name_of_held));
        let (truth, bound) = self.test(&held, &Value::Written(receiver.clone()))?;
        let (Truth::Where(is_some), Some((_, held))) = (truth, bound.into_iter().next()) else {
            return refuse(method, "this option cannot be followed here");
        };
        let last = values.pop().unwrap_or(Value::Unset);
        let first = values.pop();
        let known = |truth| move |_: &mut Self| Ok(Value::Truth(Truth::Known(truth)));
        let value = match &*name {
            "unwrap_or" => self.branch(call, is_some, |_| Ok(held), |_| Ok(last))?,
            "unwrap_or_else" => {
                self.branch(call, is_some, |_| Ok(held), |this| this.apply(call, &last, Vec::new()))?
            }
            "is_some_and" => {
                self.branch(call, is_some, |this| this.apply(call, &last, vec![held]), known(false))?
            }
            "is_none_or" => {
                self.branch(call, is_some, |this| this.apply(call, &last, vec![held]), known(true))?
            }
            _ => {
                let default = first.unwrap_or(Value::Unset);
                let is_called = name == "map_or_else";
                self.branch(
                    call,
                    is_some,
                    |this| this.apply(call, &last, vec![held]),
                    |this| if is_called { this.apply(call, &default, Vec::new()) } else { Ok(default) },
                )?
            }
        };
        Ok(Some(value))
    }
}
