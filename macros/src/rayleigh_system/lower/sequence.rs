//! Methods of arrays and iterators.

use proc_macro2::Ident;
use syn::{BinOp, Expr, ExprMethodCall, Type, parse_quote};

use super::super::graph::Operation;
use super::super::syntax::is_self;
use super::class::IntegerType;
use super::operator::Operands;
use super::value::{Truth, Value};
use super::{Lowering, Node, Result, refuse};

/// Methods that arrays have as slices: a trait in scope with a method of that name for arrays comes before.
const OF_SLICES: [&str; 5] = ["chunks", "chunks_exact", "iter", "len", "windows"];

impl Lowering<'_> {
    pub fn sequence_method(
        &mut self,
        method: &Ident,
        entries: Vec<Value>,
        arguments: Vec<Value>,
        said: Option<&Type>,
    ) -> Result<Value> {
        let name = method.to_string();
        if OF_SLICES.contains(&name.as_str()) && entries.iter().all(|entry| matches!(entry, Value::Real(_))) {
            let length = entries.len();
            if !self.of_arrays.iter().any(|(known, of)| method == known && *of == length) {
                self.of_arrays.push((method.clone(), length));
            }
        }
        let pair = |a: Value, b: Value| Value::Tuple(vec![a, b]);
        let entries: Vec<Value> = match (name.as_str(), &arguments[..]) {
            ("iter" | "into_iter" | "copied" | "cloned" | "clone" | "as_slice" | "to_owned", []) => entries,
            ("len" | "count", []) => {
                return self.integer(method, entries.len() as i128, Some(IntegerType::USIZE));
            }
            ("map" | "flat_map", [function]) => {
                let mapped = self.collected(method, entries.len(), |this, index| {
                    this.apply(method, function, vec![entries[index].clone()])
                })?;
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
                let mut numbered = Vec::new();
                for (index, entry) in (0..).zip(entries) {
                    numbered.push(pair(self.integer(method, index, Some(IntegerType::USIZE))?, entry));
                }
                numbered
            }
            ("rev", []) => entries.into_iter().rev().collect(),
            ("chain", [Value::Sequence(others)]) => {
                if let (Some(a), Some(b)) = (entries.first(), others.first()) {
                    self.unify_values(a, b)?;
                }
                entries.into_iter().chain(others.iter().cloned()).collect()
            }
            ("skip", &[Value::Integer(count)]) => {
                entries.into_iter().skip(self.size(method, count)?).collect()
            }
            ("take", &[Value::Integer(count)]) => {
                entries.into_iter().take(self.size(method, count)?).collect()
            }
            ("step_by", &[Value::Integer(step)]) if step.value > 0 => {
                entries.into_iter().step_by(self.size(method, step)?).collect()
            }
            ("windows", &[Value::Integer(width)]) if width.value > 0 => {
                let width = self.size(method, width)?;
                let count = (entries.len() + 1).saturating_sub(width);
                self.collected(method, count, |_, start| {
                    Ok(Value::Sequence(entries[start..start + width].to_vec()))
                })?
            }
            ("chunks", &[Value::Integer(width)]) if width.value > 0 => entries
                .chunks(self.size(method, width)?)
                .map(|chunk| Value::Sequence(chunk.to_vec()))
                .collect(),
            ("chunks_exact", &[Value::Integer(width)]) if width.value > 0 => entries
                .chunks_exact(self.size(method, width)?)
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
            ("sum" | "product", []) => return self.total(method, entries, said),
            ("any" | "all", [function]) => return self.decided(method, entries, function),
            ("contains", [_]) => return refuse(method, "compare the entries one by one"),
            ("fold", [start, function]) => {
                let mut total = start.clone();
                for entry in entries {
                    let before = total.clone();
                    total = self.apply(method, function, vec![total, entry])?;
                    self.unify_values(&before, &total)?;
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
        self.of_bounded_size(method, Value::Sequence(entries))
    }

    /// `numbers.reduce(function).unwrap()`, or `unwrap_or(default)`; nothing if it is another method.
    pub fn reduced(&mut self, call: &ExprMethodCall) -> Result<Option<Value>> {
        let Expr::MethodCall(inner) = &*call.receiver else { return Ok(None) };
        let is_reduce = inner.method == "reduce" && !is_self(&inner.receiver);
        let (Some(function), true) = (inner.args.first(), is_reduce) else { return Ok(None) };
        let arguments: Vec<&Expr> = call.args.iter().collect();
        let default = match (call.method.to_string().as_str(), &arguments[..]) {
            ("unwrap", []) | ("expect", [_]) => None,
            ("unwrap_or", [default]) => Some(*default),
            _ => return Ok(None),
        };
        let Value::Sequence(entries) = self.expression(&inner.receiver)? else {
            return refuse(&inner.method, "the length of what is reduced is not known here; give it a type");
        };
        let function = self.expression(function)?;
        let default = default.map(|default| self.expression(default)).transpose()?;
        let mut entries = entries.into_iter();
        let Some(mut total) = entries.next().or(default) else {
            return refuse(&call.method, "nothing is reduced here: this panics");
        };
        for entry in entries {
            total = self.apply(&inner.method, &function, vec![total, entry])?;
        }
        Ok(Some(total))
    }

    /// Whether the closure holds for any or for all; closures change nothing, so that the order of asking
    /// does not matter.
    fn decided(&mut self, method: &Ident, entries: Vec<Value>, function: &Value) -> Result<Value> {
        let is_any = method == "any";
        let mut truth = Truth::Known(!is_any);
        let outside = self.guards.len();
        for entry in entries {
            let asked = self.apply(method, function, vec![entry])?;
            let asked = self.truth(method, asked)?;
            truth = if is_any { truth.or(&mut self.graph, asked) } else { truth.and(&mut self.graph, asked) };
            match truth {
                // What comes later is not asked.
                Truth::Known(known) if known == is_any => break,
                Truth::Where(node) => self.guards.push((node, !is_any)),
                Truth::Known(_) => {}
            }
        }
        self.guards.truncate(outside);
        Ok(Value::Truth(truth))
    }

    /// The sum or the product, from left to right. Rust starts sums of floating-point numbers at −0, which
    /// changes nothing.
    fn total(&mut self, method: &Ident, entries: Vec<Value>, said: Option<&Type>) -> Result<Value> {
        let is_sum = method == "sum";
        let ty = said.and_then(IntegerType::of);
        let are_integers = entries.iter().all(|entry| matches!(entry, Value::Integer(_) | Value::Chosen(_)))
            && entries.iter().any(|entry| matches!(entry, Value::Integer(_)));
        let are_written = entries.iter().any(|entry| matches!(entry, Value::Written(_)))
            && entries.iter().all(|entry| !matches!(entry, Value::Real(_)));
        if are_integers || are_written || ty.is_some() {
            let operator: BinOp = if is_sum { parse_quote!(+) } else { parse_quote!(*) };
            let at = Operands { whole: method, left: method, right: method };
            let mut total = None;
            for entry in entries {
                total = Some(match total {
                    None => entry,
                    Some(total) => self.operate(at, &operator, total, entry)?,
                });
            }
            return match total {
                Some(Value::Integer(total)) => {
                    if let Some(ty) = ty {
                        self.of_type(total.class, ty)?;
                    }
                    Ok(Value::Integer(total))
                }
                Some(total) => Ok(total),
                None => self.integer(method, i128::from(!is_sum), ty),
            };
        }
        let mut total: Option<Node> = None;
        for entry in entries {
            let entry = self.scalar(method, entry)?;
            total = Some(match total {
                None => entry,
                Some(total) if is_sum => self.graph.add(total, entry),
                Some(total) => self.graph.node(Operation::Multiply(total, entry)),
            });
        }
        let empty = if is_sum { -0.0 } else { 1.0 };
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
