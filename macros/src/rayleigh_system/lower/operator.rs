//! Expressions: literals, paths, operators, places, casts, calls.

use quote::{ToTokens, quote};
use syn::{
    BinOp, Expr, ExprBinary, ExprCall, ExprCast, ExprPath, ExprRange, ExprUnary, Lit, Member, RangeLimits,
    UnOp,
};

use super::super::graph::{Comparison, Operation};
use super::super::model::{is_integer, simple_name};
use super::value::{Truth, Value, Written};
use super::{Lowering, Result, refuse};

impl Lowering<'_> {
    /// Runs an expression.
    pub fn expression(&mut self, expression: &Expr) -> Result<Value> {
        self.count(expression)?;
        match expression {
            Expr::Lit(literal) => self.literal(&literal.lit),
            Expr::Path(path) => self.path(path),
            Expr::Paren(inner) => self.expression(&inner.expr),
            Expr::Group(inner) => self.expression(&inner.expr),
            Expr::Unary(unary) => self.unary(unary),
            Expr::Binary(binary) => self.binary(binary),
            Expr::Assign(assignment) => {
                let value = self.expression(&assignment.right)?;
                self.assign(&assignment.left, value)
            }
            Expr::Reference(reference) if reference.mutability.is_none() => self.expression(&reference.expr),
            Expr::Field(field) => {
                let base = self.expression(&field.base)?;
                self.field(expression, base, &field.member)
            }
            Expr::Index(index) => {
                let base = self.expression(&index.expr)?;
                if let Expr::Range(range) = &*index.index {
                    return self.slice(base, range);
                }
                let index_value = self.expression(&index.index)?;
                self.entry(index, base, index_value)
            }
            Expr::Array(array) => array
                .elems
                .iter()
                .map(|entry| self.expression(entry))
                .collect::<Result<_>>()
                .map(Value::Sequence),
            Expr::Repeat(repeat) => {
                let (value, length) = (self.expression(&repeat.expr)?, self.length(&repeat.len)?);
                Ok(Value::Sequence(vec![value; length]))
            }
            Expr::Tuple(tuple) => tuple
                .elems
                .iter()
                .map(|entry| self.expression(entry))
                .collect::<Result<_>>()
                .map(Value::Tuple),
            Expr::Range(range) => self.range(range),
            Expr::Cast(cast) => self.cast(cast),
            Expr::Call(call) => self.path_call(call),
            Expr::MethodCall(call) => self.method_call(call),
            Expr::Closure(closure) => Ok(self.closure(closure)),
            Expr::Block(block) if block.label.is_none() => self.block(&block.block),
            Expr::If(choice) => self.choice(choice),
            Expr::Match(choice) => self.match_known(choice),
            Expr::ForLoop(each) => self.for_loop(each),
            Expr::While(repeated) => self.while_loop(repeated),
            Expr::Return(_) | Expr::Break(_) | Expr::Continue(_) => self.departure(expression),
            other => refuse(
                other,
                "this form cannot be followed at compile time; write it with `let`, `if`, `for` and arithmetic",
            ),
        }
    }

    fn literal(&mut self, literal: &Lit) -> Result<Value> {
        match literal {
            Lit::Float(float) => match float.base10_parse() {
                Ok(value) => Ok(Value::Real(self.graph.constant(value))),
                Err(_) => refuse(literal, "not a number that can be read"),
            },
            Lit::Int(integer) if matches!(integer.suffix(), "f64" | "f32") => {
                match integer.base10_parse::<f64>() {
                    Ok(value) => Ok(Value::Real(self.graph.constant(value))),
                    Err(_) => refuse(literal, "not a number that can be read"),
                }
            }
            Lit::Int(integer) => match integer.base10_parse() {
                Ok(value) => Ok(Value::Integer(value)),
                Err(_) => refuse(literal, "not an integer that can be read"),
            },
            Lit::Bool(truth) => Ok(Value::Truth(Truth::Known(truth.value))),
            _ => refuse(literal, "neither a number nor a bool"),
        }
    }

    fn path(&mut self, path: &ExprPath) -> Result<Value> {
        if path.path.is_ident("self") {
            return Ok(Value::System);
        }
        if let Some(name) = path.path.get_ident()
            && let Some(value) = self.local(name)
        {
            return Ok(value.clone());
        }
        let Some(last) = path.path.segments.last() else {
            return refuse(path, "not a name");
        };
        let name = last.ident.clone();
        let first = &path.path.segments[0].ident;
        let of_block = path.path.segments.len() == 2 && (first == "Self" || *first == *self.source.name());
        if of_block && self.function(&name).is_some() {
            return Ok(Value::Function(name));
        }
        if of_block && let Some(constant) = self.block_constant(&name) {
            return self.expression(&constant);
        }
        // `consts::PI` after `use std::f64::consts;`
        if path.path.segments.len() > 1
            && let Some(Value::Written(module)) = self.local(first).cloned()
        {
            let (module, rest) = (module.tokens(), path.path.segments.iter().skip(1));
            return Ok(Value::Written(Written::leaf(quote!(#module #(:: #rest)*))));
        }
        let spelled = name.to_string();
        if spelled.contains(char::is_uppercase) && !spelled.contains(char::is_lowercase) {
            return Ok(Value::Written(Written::leaf(path.to_token_stream())));
        }
        if first == "f64" || first == "f32" {
            return Ok(Value::Method(name));
        }
        refuse(
            path,
            format!(
                "`{name}` is not known here; use locals, fields, constants and functions of the annotated block"
            ),
        )
    }

    fn unary(&mut self, unary: &ExprUnary) -> Result<Value> {
        let value = self.expression(&unary.expr)?;
        match (&unary.op, value) {
            (UnOp::Deref(_), value) => Ok(value),
            (UnOp::Neg(_), Value::Integer(value)) => Ok(Value::Integer(-value)),
            (UnOp::Neg(_), Value::Written(written)) => {
                Ok(Value::Written(Written::Negative(Box::new(written))))
            }
            (UnOp::Neg(_), value) => {
                let node = self.scalar(unary, value)?;
                Ok(Value::Real(match self.graph.constant_value(node) {
                    Some(value) => self.graph.constant(-value),
                    None => self.graph.node(Operation::Negate(node)),
                }))
            }
            (UnOp::Not(_), value @ (Value::Truth(_) | Value::Written(_))) => {
                let truth = self.truth(unary, value)?;
                Ok(Value::Truth(truth.not(&mut self.graph)))
            }
            _ => refuse(unary, "this operator cannot be followed at compile time"),
        }
    }

    fn binary(&mut self, binary: &ExprBinary) -> Result<Value> {
        let ExprBinary { left, op, right, .. } = binary;
        if let BinOp::And(_) | BinOp::Or(_) = op {
            let left_value = self.expression(left)?;
            let a = self.truth(left, left_value)?;
            // The right side of a decided condition is not run.
            match (op, a) {
                (BinOp::And(_), Truth::Known(false)) | (BinOp::Or(_), Truth::Known(true)) => {
                    return Ok(Value::Truth(a));
                }
                _ => {}
            }
            let right_value = self.expression(right)?;
            let b = self.truth(right, right_value)?;
            let graph = &mut self.graph;
            return Ok(Value::Truth(if let BinOp::And(_) = op { a.and(graph, b) } else { a.or(graph, b) }));
        }
        if let Some(operator) = plain(op) {
            // Rust evaluates the right side of a compound assignment to a number first.
            let right_value = self.expression(right)?;
            let left_value = self.expression(left)?;
            let value = self.operate(binary, &operator, left_value, right_value)?;
            return self.assign(left, value);
        }
        let (left, right) = (self.expression(left)?, self.expression(right)?);
        self.operate(binary, op, left, right)
    }

    /// `left operator right`.
    pub fn operate(&mut self, at: &ExprBinary, operator: &BinOp, left: Value, right: Value) -> Result<Value> {
        match (left, right) {
            (Value::Integer(a), Value::Integer(b)) => integers(at, operator, a, b),
            (Value::Truth(a), Value::Truth(b)) if matches!(operator, BinOp::Eq(_) | BinOp::Ne(_)) => {
                let (Truth::Known(a), Truth::Known(b)) = (a, b) else {
                    return refuse(
                        at,
                        "conditions cannot be compared here; combine them with `&&`, `||` and `!`",
                    );
                };
                Ok(Value::Truth(Truth::Known((a == b) == matches!(operator, BinOp::Eq(_)))))
            }
            // Fields and constants alone: what they are, rustc knows.
            (Value::Written(a), Value::Written(b)) => {
                Ok(Value::Written(Written::Binary(*operator, Box::new(a), Box::new(b))))
            }
            (Value::Written(a), Value::Integer(b)) => {
                let b = Box::new(integer(b));
                Ok(Value::Written(Written::Binary(*operator, Box::new(a), b)))
            }
            (Value::Integer(a), Value::Written(b)) => {
                let a = Box::new(integer(a));
                Ok(Value::Written(Written::Binary(*operator, a, Box::new(b))))
            }
            (left, right) => {
                let (a, b) = (self.scalar(&at.left, left)?, self.scalar(&at.right, right)?);
                let operation = match operator {
                    BinOp::Add(_) => return Ok(Value::Real(self.graph.add(a, b))),
                    BinOp::Sub(_) => Operation::Subtract(a, b),
                    BinOp::Mul(_) => Operation::Multiply(a, b),
                    BinOp::Div(_) => Operation::Divide(a, b),
                    _ => {
                        let comparison = match operator {
                            BinOp::Lt(_) => Comparison::Less,
                            BinOp::Le(_) => Comparison::LessOrEqual,
                            BinOp::Gt(_) => Comparison::Greater,
                            BinOp::Ge(_) => Comparison::GreaterOrEqual,
                            BinOp::Eq(_) => Comparison::Equal,
                            BinOp::Ne(_) => Comparison::NotEqual,
                            _ => {
                                return refuse(
                                    operator,
                                    "this operator has no derivative; angles need no wrapping, coordinates live in ℝ",
                                );
                            }
                        };
                        let node = self.graph.node(Operation::Compare(comparison, a, b));
                        return Ok(Value::Truth(Truth::Where(node)));
                    }
                };
                Ok(Value::Real(self.graph.node(operation)))
            }
        }
    }

    fn field(&mut self, at: &Expr, base: Value, member: &Member) -> Result<Value> {
        match (base, member) {
            (Value::System, _) => Ok(Value::Written(Written::leaf(at.to_token_stream()))),
            (Value::Written(base), member) => {
                let base = base.operand();
                Ok(Value::Written(Written::leaf(quote!(#base.#member))))
            }
            (Value::Tuple(entries), Member::Unnamed(index)) if (index.index as usize) < entries.len() => {
                Ok(entries[index.index as usize].clone())
            }
            _ => refuse(member, "this member is not known here"),
        }
    }

    fn entry(&mut self, at: &impl ToTokens, base: Value, index: Value) -> Result<Value> {
        match (base, index) {
            (Value::Sequence(entries), Value::Integer(index)) => {
                match usize::try_from(index).ok().and_then(|index| entries.get(index)) {
                    Some(entry) => Ok(entry.clone()),
                    None => {
                        refuse(at, format!("index {index} is outside an array of length {}", entries.len()))
                    }
                }
            }
            (Value::Written(array), Value::Integer(index)) => match usize::try_from(index) {
                Ok(index) => Ok(Value::Written(array.entry(index))),
                Err(_) => refuse(at, "a negative index"),
            },
            (Value::Written(array), Value::Written(index)) => {
                let (array, index) = (array.operand(), index.tokens());
                Ok(Value::Written(Written::leaf(quote!(#array[#index]))))
            }
            _ => refuse(
                at,
                "this index is not known at compile time; use a literal, a constant of the block or a loop variable",
            ),
        }
    }

    fn slice(&mut self, base: Value, range: &ExprRange) -> Result<Value> {
        let Value::Sequence(entries) = base else {
            return refuse(range, "a slice of something whose length is not known here");
        };
        let start = self.bound(range.start.as_deref(), 0)?;
        let mut end = self.bound(range.end.as_deref(), entries.len() as i128)?;
        if matches!(range.limits, RangeLimits::Closed(_)) && range.end.is_some() {
            end += 1;
        }
        if start < 0 || end < start || end > entries.len() as i128 {
            return refuse(range, "this range leaves the array");
        }
        Ok(Value::Sequence(entries[start as usize..end as usize].to_vec()))
    }

    fn range(&mut self, range: &ExprRange) -> Result<Value> {
        let Some(end) = range.end.as_deref() else {
            return refuse(range, "a range without an end; write the end out");
        };
        let start = self.bound(range.start.as_deref(), 0)?;
        let mut end = self.bound(Some(end), 0)?;
        if matches!(range.limits, RangeLimits::Closed(_)) {
            end += 1;
        }
        if end - start > super::MAX_NODES as i128 {
            return refuse(range, "the loops, written out, are too long for straight-line code");
        }
        Ok(Value::Sequence((start..end).map(Value::Integer).collect()))
    }

    fn bound(&mut self, bound: Option<&Expr>, default: i128) -> Result<i128> {
        let Some(bound) = bound else { return Ok(default) };
        match self.expression(bound)? {
            Value::Integer(value) => Ok(value),
            _ => refuse(
                bound,
                "this bound is not known at compile time; use a literal, a constant of the annotated block or `q.len()`",
            ),
        }
    }

    fn cast(&mut self, cast: &ExprCast) -> Result<Value> {
        let value = self.expression(&cast.expr)?;
        let ty = &cast.ty;
        let to_float = simple_name(ty).is_some_and(|name| name == "f64" || name == "f32");
        match value {
            Value::Integer(value) if to_float => Ok(Value::Real(self.graph.constant(value as f64))),
            Value::Integer(_) if is_integer(ty) => Ok(value),
            Value::Real(_) if to_float => Ok(value),
            Value::Truth(Truth::Known(truth)) if is_integer(ty) => Ok(Value::Integer(i128::from(truth))),
            Value::Written(written) => {
                let operand = written.operand();
                Ok(Value::Written(Written::leaf(quote!((#operand as #ty)))))
            }
            _ => refuse(
                cast,
                "only integers can be cast here; to choose between cases, compare: `if q[0] > 0.0 { … } else { … }`",
            ),
        }
    }

    fn path_call(&mut self, call: &ExprCall) -> Result<Value> {
        if let Expr::Path(path) = &*call.func {
            let segments: Vec<String> =
                path.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
            match segments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
                [.., "array", "from_fn"] => return self.array_from_fn(call),
                ["f64" | "f32", "from"] if call.args.len() == 1 => {
                    return match self.expression(&call.args[0])? {
                        Value::Integer(value) => Ok(Value::Real(self.graph.constant(value as f64))),
                        Value::Written(written) => {
                            let (function, operand) = (&call.func, written.tokens());
                            Ok(Value::Written(Written::leaf(quote!(#function(#operand)))))
                        }
                        value @ Value::Real(_) => Ok(value),
                        _ => refuse(call, "only numbers can be converted here"),
                    };
                }
                _ => {}
            }
        }
        let function = self.expression(&call.func)?;
        let arguments =
            call.args.iter().map(|argument| self.expression(argument)).collect::<Result<Vec<_>>>()?;
        // `Self::height(self, q)`.
        let arguments = match (&function, arguments.first()) {
            (Value::Function(_), Some(Value::System)) => arguments[1..].to_vec(),
            _ => arguments,
        };
        self.apply(call, &function, arguments)
    }

    fn array_from_fn(&mut self, call: &ExprCall) -> Result<Value> {
        let Some(length) = self.expected else {
            return refuse(
                call,
                "the length is not known here; give the array a type, as in `let a: [f64; 3] = …`",
            );
        };
        let Some(function) = call.args.first() else { return refuse(call, "called without a function") };
        let function = self.expression(function)?;
        let entries =
            (0..length).map(|index| self.apply(call, &function, vec![Value::Integer(index as i128)]));
        entries.collect::<Result<_>>().map(Value::Sequence)
    }
}

/// An integer beside a field: its type is the field's.
fn integer(value: i128) -> Written {
    let literal = proc_macro2::Literal::i128_unsuffixed(value);
    Written::leaf(quote!(#literal))
}

fn integers(at: &ExprBinary, operator: &BinOp, a: i128, b: i128) -> Result<Value> {
    let known = |truth| Ok(Value::Truth(Truth::Known(truth)));
    let result = match operator {
        BinOp::Add(_) => a.checked_add(b),
        BinOp::Sub(_) => a.checked_sub(b),
        BinOp::Mul(_) => a.checked_mul(b),
        BinOp::Div(_) => a.checked_div(b),
        BinOp::Rem(_) => a.checked_rem(b),
        BinOp::BitAnd(_) => Some(a & b),
        BinOp::BitOr(_) => Some(a | b),
        BinOp::Shl(_) => u32::try_from(b).ok().and_then(|b| a.checked_shl(b)),
        BinOp::Shr(_) => u32::try_from(b).ok().and_then(|b| a.checked_shr(b)),
        BinOp::Lt(_) => return known(a < b),
        BinOp::Le(_) => return known(a <= b),
        BinOp::Gt(_) => return known(a > b),
        BinOp::Ge(_) => return known(a >= b),
        BinOp::Eq(_) => return known(a == b),
        BinOp::Ne(_) => return known(a != b),
        _ => None,
    };
    match result {
        Some(value) => Ok(Value::Integer(value)),
        None => refuse(at, "this integer cannot be computed at compile time"),
    }
}

/// The operator of a compound assignment.
fn plain(operator: &BinOp) -> Option<BinOp> {
    let span = super::super::diagnostics::span_of(operator);
    Some(match operator {
        BinOp::AddAssign(_) => BinOp::Add(syn::Token![+](span)),
        BinOp::SubAssign(_) => BinOp::Sub(syn::Token![-](span)),
        BinOp::MulAssign(_) => BinOp::Mul(syn::Token![*](span)),
        BinOp::DivAssign(_) => BinOp::Div(syn::Token![/](span)),
        BinOp::RemAssign(_) => BinOp::Rem(syn::Token![%](span)),
        _ => return None,
    })
}
