//! Methods: of the system, of numbers.

use proc_macro2::Ident;
use syn::{Expr, ExprMethodCall, ExprRange, RangeLimits, Type};

use super::super::diagnostics::span_of;
use super::super::differentiate::extremum;
use super::super::functions::is_known;
use super::super::graph::{Comparison, Function, Operation, PairFunction, Predicate};
use super::super::syntax::{ROUNDING, jumps};
use super::class::IntegerType;
use super::operator::Operands;
use super::value::{Truth, Value};
use super::{Lowering, Node, Refusal, Result, refuse};

impl Lowering<'_> {
    pub fn method_call(&mut self, call: &ExprMethodCall) -> Result<Value> {
        if let Some(range) = as_range(&call.receiver)
            && call.method == "contains"
            && let [value] = &call.args.iter().collect::<Vec<_>>()[..]
        {
            return self.range_contains(range, value);
        }
        if let Some(value) = self.swap_entries(call)? {
            return Ok(value);
        }
        if let Some(value) = self.reduced(call)? {
            return Ok(value);
        }
        let receiver = self.expression(&call.receiver)?;
        if let Value::Written(written) = &receiver
            && let Some(value) = self.option_method(call, written)?
        {
            return Ok(value);
        }
        let arguments =
            call.args.iter().map(|argument| self.expression(argument)).collect::<Result<Vec<_>>>()?;
        match receiver {
            Value::System => {
                let Some(function) = self.function(&call.method).cloned() else {
                    return refuse(
                        &call.method,
                        format!("`{}` is no function of the annotated block", call.method),
                    );
                };
                self.call(&call.method, &function.sig, &function.block, arguments)
            }
            receiver => {
                let said = call.turbofish.as_ref().and_then(|turbofish| turbofish.args.first());
                let said = match said {
                    Some(syn::GenericArgument::Type(ty)) => Some(ty),
                    _ => None,
                };
                self.value_method(&call.method, receiver, arguments, said)
            }
        }
    }

    /// A method of a value; `said` is the type behind its name.
    pub fn value_method(
        &mut self,
        method: &Ident,
        receiver: Value,
        arguments: Vec<Value>,
        said: Option<&Type>,
    ) -> Result<Value> {
        match receiver {
            receiver if method == "clone" && arguments.is_empty() => Ok(receiver),
            Value::Sequence(entries) => self.sequence_method(method, entries, arguments, said),
            Value::Integer(integer) => {
                if let Some(Value::Chosen(argument)) = arguments.first().filter(|_| arguments.len() == 1) {
                    return self.distribute(method, argument, |this, argument| {
                        this.value_method(method, Value::Integer(integer), vec![argument], None)
                    });
                }
                if let [Value::Written(_)] = &arguments[..] {
                    self.beside_field(integer);
                    let receiver = self.typed_literal(integer);
                    if let Some(value) = self.written_method(method, &receiver, &arguments)? {
                        return Ok(value);
                    }
                }
                self.integer_method(method, integer, &arguments)
            }
            Value::Written(written) if method == "at" && is_place(&arguments) => {
                self.characteristic(method, &written, arguments)
            }
            Value::Chosen(chosen) if method == "at" && is_place(&arguments) => {
                self.distribute(method, &chosen, |this, receiver| {
                    this.value_method(method, receiver, arguments.clone(), None)
                })
            }
            Value::Written(written) => match self.written_method(method, &written, &arguments)? {
                Some(value) => Ok(value),
                None if jumps(method) => self.rounded(method, Value::Written(written), &arguments),
                None => self.number_method(method, Value::Written(written), arguments),
            },
            Value::Chosen(chosen) if !arguments.iter().any(|argument| matches!(argument, Value::Real(_))) => {
                self.distribute(method, &chosen, |this, receiver| {
                    this.value_method(method, receiver, arguments.clone(), None)
                })
            }
            Value::Real(_) if jumps(method) => self.rounded(method, receiver, &arguments),
            Value::Real(_) | Value::Chosen(_) => self.number_method(method, receiver, arguments),
            _ => refuse(method, format!("the method `{method}` cannot be followed at compile time")),
        }
    }

    /// `(low..high).contains(&value)`
    fn range_contains<'r>(&mut self, range: &'r ExprRange, value: &'r Expr) -> Result<Value> {
        let mut read = |bound: &'r Option<Box<Expr>>| {
            bound.as_deref().map(|bound| Ok((bound, self.expression(bound)?))).transpose()
        };
        let (start, end) = (read(&range.start)?, read(&range.end)?);
        let inner = self.expression(value)?;
        let is_closed = matches!(range.limits, RangeLimits::Closed(_));
        let mut holds = Truth::Known(true);
        let span = span_of(range);
        let upper = if is_closed {
            syn::BinOp::Le(syn::Token![<=](span))
        } else {
            syn::BinOp::Lt(syn::Token![<](span))
        };
        let lower = syn::BinOp::Le(syn::Token![<=](span));
        for (bound, operator, is_lower) in [(start, lower, true), (end, upper, false)] {
            let Some(bound) = bound else { continue };
            let value = (value, inner.clone());
            let ((at_left, left), (at_right, right)) = if is_lower { (bound, value) } else { (value, bound) };
            let at = Operands { whole: range, left: at_left, right: at_right };
            let compared = self.operate(at, &operator, left, right)?;
            let compared = self.truth(range, compared)?;
            holds = holds.and(&mut self.graph, compared);
        }
        Ok(Value::Truth(holds))
    }

    pub fn number_method(&mut self, method: &Ident, receiver: Value, arguments: Vec<Value>) -> Result<Value> {
        let value = self.method_of_number(method, receiver, arguments)?;
        if let Value::Real(node) = value {
            self.methods.entry(node).or_insert_with(|| method.span());
        }
        Ok(value)
    }

    fn method_of_number(&mut self, method: &Ident, receiver: Value, arguments: Vec<Value>) -> Result<Value> {
        let name = method.to_string();
        if matches!(receiver, Value::Real(_)) && !is_method_of_floats(&name) {
            let reason = format!(
                "`{method}` is no method of floating-point numbers with a derivative; make it a function of the annotated block"
            );
            return Err(Refusal::at(method, reason).for_all());
        }
        let unknown = || -> Result<Value> {
            refuse(
                method,
                format!(
                    "the method `{method}` has no derivative here, or works on something whose length is not known; give the local a type, as in `let a: [f64; 3] = self.a;`"
                ),
            )
        };
        if name == "clone" && arguments.is_empty() {
            return Ok(receiver);
        }
        if name == "powi" {
            let x = self.scalar(method, receiver)?;
            return match arguments[..] {
                [Value::Integer(n)] => {
                    self.of_type(n.class, IntegerType::I32)?;
                    match i32::try_from(n.value) {
                        Ok(n) => Ok(Value::Real(self.graph.power(x, n))),
                        Err(_) => refuse(method, "an exponent beyond `i32`"),
                    }
                }
                _ => refuse(method, "the exponent of `powi` is not known at compile time; use `powf`"),
            };
        }
        if !is_known(&name) && Predicate::named(&name).is_none() {
            return unknown();
        }
        let x = self.scalar(method, receiver)?;
        let arguments: Vec<Node> =
            arguments.into_iter().map(|argument| self.scalar(method, argument)).collect::<Result<_>>()?;
        let is_single = self.scalar == "f32";
        let graph = &mut self.graph;
        if let (Some(predicate), []) = (Predicate::named(&name), &arguments[..]) {
            return Ok(Value::Truth(Truth::Where(graph.node(Operation::Is(predicate, x)))));
        }
        if let (Some(function), []) = (Function::named(&name), &arguments[..]) {
            return Ok(Value::Real(graph.function(function, x)));
        }
        if let (Some(function), &[y]) = (PairFunction::named(&name), &arguments[..]) {
            return Ok(Value::Real(graph.node(Operation::Pair(function, x, y))));
        }
        let node = match (name.as_str(), &arguments[..]) {
            ("sin_cos", []) => {
                let (sine, cosine) = (graph.function(Function::Sin, x), graph.function(Function::Cos, x));
                return Ok(Value::Tuple(vec![Value::Real(sine), Value::Real(cosine)]));
            }
            ("min", &[y]) => extremum(graph, Comparison::Less, x, y),
            ("max", &[y]) => extremum(graph, Comparison::Greater, x, y),
            ("clamp", &[low, high]) => {
                let below = graph.node(Operation::Compare(Comparison::Less, x, low));
                let above = graph.node(Operation::Compare(Comparison::Greater, x, high));
                let raised = graph.select(below, low, x);
                graph.select(above, high, raised)
            }
            ("mul_add", &[a, b]) => graph.node(Operation::MultiplyAdd(x, a, b)),
            ("to_radians", []) => {
                let single = f64::from(core::f32::consts::PI / 180.0);
                let factor = if is_single { single } else { core::f64::consts::PI / 180.0 };
                let factor = graph.constant(factor);
                graph.node(Operation::Multiply(x, factor))
            }
            ("to_degrees", []) => {
                // The constant that `f32::to_degrees` has.
                let single = f64::from(57.295_78_f32);
                let factor = if is_single { single } else { 180.0 / core::f64::consts::PI };
                let factor = graph.constant(factor);
                graph.node(Operation::Multiply(x, factor))
            }
            ("log", &[base]) => {
                let (x, base) = (graph.function(Function::Ln, x), graph.function(Function::Ln, base));
                graph.node(Operation::Divide(x, base))
            }
            _ => return unknown(),
        };
        Ok(Value::Real(node))
    }
}

/// Whether the arguments are one number that a characteristic can be taken at, no index.
fn is_place(arguments: &[Value]) -> bool {
    matches!(arguments, [Value::Real(_) | Value::Written(_) | Value::Chosen(_)])
}

/// Whether floating-point numbers have a method of that name, here or over dual numbers.
fn is_method_of_floats(name: &str) -> bool {
    const OTHERS: [&str; 27] = [
        "add",
        "classify",
        "clone",
        "clone_into",
        "cmp",
        "div",
        "div_euclid",
        "eq",
        "ge",
        "gt",
        "into",
        "is_normal",
        "is_subnormal",
        "le",
        "lt",
        "midpoint",
        "mul",
        "ne",
        "neg",
        "partial_cmp",
        "rem",
        "rem_euclid",
        "sub",
        "to_owned",
        "total_cmp",
        "try_into",
        "borrow",
    ];
    is_known(name) || ROUNDING.contains(&name) || OTHERS.contains(&name) || Predicate::named(name).is_some()
}

/// The range, without parentheses.
fn as_range(expression: &Expr) -> Option<&ExprRange> {
    match expression {
        Expr::Range(range) => Some(range),
        Expr::Paren(inner) => as_range(&inner.expr),
        Expr::Group(inner) => as_range(&inner.expr),
        _ => None,
    }
}
