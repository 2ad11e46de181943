//! Methods: of the system, of numbers, of integers, of arrays and iterators.

use proc_macro2::Ident;
use syn::ExprMethodCall;

use super::super::differentiate::extremum;
use super::super::graph::{Comparison, Function, Operation, PairFunction, Predicate};
use super::value::{Truth, Value};
use super::{Lowering, Node, Result, refuse};

impl Lowering<'_> {
    pub fn method_call(&mut self, call: &ExprMethodCall) -> Result<Value> {
        let receiver = self.expression(&call.receiver)?;
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
            receiver => self.value_method(&call.method, receiver, arguments),
        }
    }

    /// A method of a value.
    pub fn value_method(&mut self, method: &Ident, receiver: Value, arguments: Vec<Value>) -> Result<Value> {
        match receiver {
            Value::Sequence(entries) => self.sequence_method(method, entries, arguments),
            Value::Integer(value) => integer_method(method, value, &arguments),
            Value::Real(_) | Value::Written(_) => self.number_method(method, receiver, arguments),
            receiver if method == "clone" && arguments.is_empty() => Ok(receiver),
            _ => refuse(method, format!("the method `{method}` cannot be followed at compile time")),
        }
    }

    fn number_method(&mut self, method: &Ident, receiver: Value, arguments: Vec<Value>) -> Result<Value> {
        let name = method.to_string();
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
                [Value::Integer(n)] if i32::try_from(n).is_ok() => {
                    Ok(Value::Real(self.graph.power(x, n as i32)))
                }
                _ => refuse(method, "the exponent of `powi` is not known at compile time; use `powf`"),
            };
        }
        let known = Function::named(&name).is_some()
            || PairFunction::named(&name).is_some()
            || Predicate::named(&name).is_some()
            || ["sin_cos", "min", "max", "clamp", "mul_add", "to_radians", "to_degrees", "log"]
                .contains(&name.as_str());
        if !known {
            return unknown();
        }
        let x = self.scalar(method, receiver)?;
        let arguments: Vec<Node> =
            arguments.into_iter().map(|argument| self.scalar(method, argument)).collect::<Result<_>>()?;
        let graph = &mut self.graph;
        if let (Some(predicate), []) = (Predicate::named(&name), &arguments[..]) {
            return Ok(Value::Truth(Truth::Where(graph.node(Operation::Is(predicate, x)))));
        }
        let node = match (name.as_str(), &arguments[..]) {
            (_, []) if Function::named(&name).is_some() => {
                let Some(function) = Function::named(&name) else { return unknown() };
                graph.function(function, x)
            }
            (_, &[y]) if PairFunction::named(&name).is_some() => {
                let Some(function) = PairFunction::named(&name) else { return unknown() };
                graph.node(Operation::Pair(function, x, y))
            }
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
                let factor = graph.constant(core::f64::consts::PI / 180.0);
                graph.node(Operation::Multiply(x, factor))
            }
            ("to_degrees", []) => {
                let factor = graph.constant(180.0 / core::f64::consts::PI);
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

    fn sequence_method(
        &mut self,
        method: &Ident,
        entries: Vec<Value>,
        arguments: Vec<Value>,
    ) -> Result<Value> {
        let name = method.to_string();
        let pair = |a: Value, b: Value| Value::Tuple(vec![a, b]);
        let entries: Vec<Value> = match (name.as_str(), &arguments[..]) {
            (
                "iter" | "into_iter" | "copied" | "cloned" | "clone" | "by_ref" | "as_slice" | "to_owned",
                [],
            ) => entries,
            ("len" | "count", []) => return Ok(Value::Integer(entries.len() as i128)),
            ("map" | "flat_map", [function]) => {
                let mut mapped = Vec::new();
                for entry in entries {
                    mapped.push(self.apply(method, function, vec![entry])?);
                }
                if name == "map" { mapped } else { flattened(method, mapped)? }
            }
            ("flatten", []) => flattened(method, entries)?,
            ("zip", [Value::Sequence(others)]) => {
                entries.into_iter().zip(others.iter().cloned()).map(|(a, b)| pair(a, b)).collect()
            }
            ("zip", _) => {
                return refuse(
                    method,
                    "the length of what is zipped with is not known here; give it a type, as in `let m: [f64; 3] = self.m;`, or use an index",
                );
            }
            ("enumerate", []) => {
                (0..).zip(entries).map(|(index, entry)| pair(Value::Integer(index), entry)).collect()
            }
            ("rev", []) => entries.into_iter().rev().collect(),
            ("chain", [Value::Sequence(others)]) => {
                entries.into_iter().chain(others.iter().cloned()).collect()
            }
            ("skip", &[Value::Integer(count)]) => entries.into_iter().skip(size(method, count)?).collect(),
            ("take", &[Value::Integer(count)]) => entries.into_iter().take(size(method, count)?).collect(),
            ("step_by", &[Value::Integer(step)]) if step > 0 => {
                entries.into_iter().step_by(size(method, step)?).collect()
            }
            ("windows", &[Value::Integer(width)]) if width > 0 => {
                entries.windows(size(method, width)?).map(|window| Value::Sequence(window.to_vec())).collect()
            }
            ("chunks", &[Value::Integer(width)]) if width > 0 => {
                entries.chunks(size(method, width)?).map(|chunk| Value::Sequence(chunk.to_vec())).collect()
            }
            ("chunks_exact", &[Value::Integer(width)]) if width > 0 => entries
                .chunks_exact(size(method, width)?)
                .map(|chunk| Value::Sequence(chunk.to_vec()))
                .collect(),
            ("filter", [function]) => {
                let mut kept = Vec::new();
                for entry in entries {
                    let chosen = self.apply(method, function, vec![entry.clone()])?;
                    match self.truth(method, chosen)? {
                        Truth::Known(true) => kept.push(entry),
                        Truth::Known(false) => {}
                        Truth::Where(_) => {
                            return refuse(
                                method,
                                "numbers decide what is kept; select a term with `if` instead",
                            );
                        }
                    }
                }
                kept
            }
            ("sum" | "product", []) => return self.total(method, entries),
            ("fold", [start, function]) => {
                let mut total = start.clone();
                for entry in entries {
                    total = self.apply(method, function, vec![total, entry])?;
                }
                return Ok(total);
            }
            _ => {
                return refuse(
                    method,
                    format!("the method `{method}` cannot be followed at compile time; use a `for` loop"),
                );
            }
        };
        Ok(Value::Sequence(entries))
    }

    /// The sum or the product, from left to right.
    fn total(&mut self, method: &Ident, entries: Vec<Value>) -> Result<Value> {
        let is_sum = method == "sum";
        let integers: Option<Vec<i128>> = entries
            .iter()
            .map(|entry| if let Value::Integer(value) = entry { Some(*value) } else { None })
            .collect();
        if let Some(integers) = integers.filter(|integers| !integers.is_empty()) {
            let total = integers.iter().try_fold(i128::from(!is_sum), |total: i128, value| {
                if is_sum { total.checked_add(*value) } else { total.checked_mul(*value) }
            });
            return match total {
                Some(total) => Ok(Value::Integer(total)),
                None => refuse(method, "this integer cannot be computed at compile time"),
            };
        }
        let mut total = None;
        for entry in entries {
            let entry = self.scalar(method, entry)?;
            total = Some(match total {
                None => entry,
                Some(total) if is_sum => self.graph.add(total, entry),
                Some(total) => self.graph.node(Operation::Multiply(total, entry)),
            });
        }
        let empty = if is_sum { 0.0 } else { 1.0 };
        Ok(Value::Real(total.unwrap_or_else(|| self.graph.constant(empty))))
    }
}

fn flattened(method: &Ident, entries: Vec<Value>) -> Result<Vec<Value>> {
    let mut flat = Vec::new();
    for entry in entries {
        match entry {
            Value::Sequence(entries) => flat.extend(entries),
            _ => return refuse(method, "what is flattened is no array whose length is known here"),
        }
    }
    Ok(flat)
}

fn size(method: &Ident, value: i128) -> Result<usize> {
    match usize::try_from(value) {
        Ok(size) => Ok(size),
        Err(_) => refuse(method, "a negative length"),
    }
}

fn integer_method(method: &Ident, value: i128, arguments: &[Value]) -> Result<Value> {
    let result = match (method.to_string().as_str(), arguments) {
        ("pow", &[Value::Integer(n)]) => u32::try_from(n).ok().and_then(|n| value.checked_pow(n)),
        ("min", &[Value::Integer(other)]) => Some(value.min(other)),
        ("max", &[Value::Integer(other)]) => Some(value.max(other)),
        ("abs", []) => value.checked_abs(),
        ("abs_diff", &[Value::Integer(other)]) => value.checked_sub(other).and_then(i128::checked_abs),
        ("saturating_sub", &[Value::Integer(other)]) => Some((value - other).max(0)),
        ("rem_euclid", &[Value::Integer(other)]) => value.checked_rem_euclid(other),
        ("clone", []) => Some(value),
        _ => None,
    };
    match result {
        Some(value) => Ok(Value::Integer(value)),
        None => {
            refuse(method, format!("the method `{method}` of an integer cannot be followed at compile time"))
        }
    }
}
