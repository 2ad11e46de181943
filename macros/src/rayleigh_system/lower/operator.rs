//! Expressions: literals, paths, operators, casts, calls.

use proc_macro2::{Span, TokenStream};
use quote::{ToTokens, quote};
use syn::{
    BinOp, Expr, ExprBinary, ExprCall, ExprCast, ExprPath, ExprRange, ExprUnary, GenericArgument, Lit,
    Member, PathArguments, RangeLimits, Type, UnOp,
};

use super::super::graph::{Comparison, Operation};
use super::super::syntax::is_plain;
use super::super::syntax::simple_name;
use super::integer::{Integer, IntegerType};
use super::place::may_assign;
use super::value::{Truth, Value};
use super::written::Written;
use super::{Lowering, Node, Result, refuse};

impl Lowering<'_> {
    /// Runs an expression.
    pub fn evaluated(&mut self, expression: &Expr) -> Result<Value> {
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
            Expr::Reference(reference) if reference.mutability.is_none() => {
                Ok(match self.expression(&reference.expr)? {
                    Value::Written(written) => Value::Written(Written::Reference(Box::new(written))),
                    value => value,
                })
            }
            Expr::Field(field) => {
                let base = self.expression(&field.base)?;
                self.field(expression, base, &field.member)
            }
            Expr::Index(index) => {
                // Rust reads a place after its indices are computed.
                if may_assign(&index.index) {
                    let place = self.place(expression)?;
                    return self.read(expression, &place);
                }
                let base = self.expression(&index.expr)?;
                if let Expr::Range(range) = &*index.index {
                    return self.slice(base, range);
                }
                let index_value = self.expression(&index.index)?;
                self.entry(index, base, index_value)
            }
            Expr::Array(array) => {
                let entries: Vec<Value> =
                    array.elems.iter().map(|entry| self.expression(entry)).collect::<Result<_>>()?;
                entries.windows(2).try_for_each(|pair| self.unify_values(&pair[0], &pair[1]))?;
                Ok(Value::Sequence(entries))
            }
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
            Expr::Call(call) => self.path_call(call, None),
            Expr::MethodCall(call) => self.method_call(call),
            Expr::Closure(closure) => Ok(self.closure(closure)),
            Expr::Block(block) if block.label.is_none() => self.block(&block.block),
            Expr::If(choice) => self.choice(choice),
            Expr::Match(choice) => self.match_arms(choice),
            Expr::Macro(invocation) => self.matches_macro(&invocation.mac),
            Expr::ForLoop(each) => self.for_loop(each),
            Expr::While(repeated) => self.while_loop(repeated),
            Expr::Loop(endless) => self.endless_loop(endless),
            Expr::Return(_) | Expr::Break(_) | Expr::Continue(_) => self.departure(expression),
            other => refuse(
                other,
                "this form cannot be followed at compile time; write it with `let`, `if`, `for` and arithmetic",
            ),
        }
    }

    /// Runs an expression whose type is written down: `array::from_fn` takes its length from there.
    pub fn expression_of_type(&mut self, expression: &Expr, ty: &Type) -> Result<Value> {
        let value = match (expression, ty) {
            (Expr::Paren(inner), ty) => self.expression_of_type(&inner.expr, ty)?,
            (Expr::Block(block), ty) if block.label.is_none() => self.block_of_type(&block.block, ty)?,
            (Expr::Call(call), Type::Array(array)) => {
                let length = self.length(&array.len)?;
                self.path_call(call, Some(length))?
            }
            _ => self.expression(expression)?,
        };
        self.shaped(value, ty)
    }

    /// A floating-point number of the program text.
    fn number(&mut self, value: f64) -> Value {
        Value::Real(self.graph.constant(value))
    }

    fn literal(&mut self, literal: &Lit) -> Result<Value> {
        let (digits, suffix) = match literal {
            Lit::Float(number) => (number.base10_digits(), number.suffix()),
            Lit::Int(number) => (number.base10_digits(), number.suffix()),
            _ => ("", ""),
        };
        let is_float = matches!(literal, Lit::Float(_)) || matches!(suffix, "f64" | "f32");
        if is_float && !suffix.is_empty() && self.scalar != suffix {
            // Another precision than the system's: rustc converts it.
            return Ok(Value::Written(Written::leaf(literal.to_token_stream())));
        }
        match literal {
            _ if is_float => self.decimal(literal, digits),
            Lit::Int(integer) => match integer.base10_parse() {
                Ok(value) => self.integer(literal, value, IntegerType::named(integer.suffix())),
                Err(_) => refuse(literal, "not an integer that can be read"),
            },
            Lit::Bool(truth) => Ok(Value::Truth(Truth::Known(truth.value))),
            _ => refuse(literal, "neither a number nor a bool"),
        }
    }

    /// The number that rustc reads: in f32 rounded once, from the digits.
    fn decimal(&mut self, literal: &Lit, digits: &str) -> Result<Value> {
        let Ok(value) = digits.parse::<f64>() else {
            return refuse(literal, "not a number that can be read");
        };
        if self.scalar == "f32" {
            let single: f32 = digits.parse().unwrap_or(f32::NAN);
            #[expect(
                clippy::cast_possible_truncation,
                reason = "whether it is rounded twice is the question"
            )]
            if (value as f32).to_bits() != single.to_bits() {
                return Ok(self.number(f64::from(single)));
            }
        }
        Ok(self.number(value))
    }

    fn path(&mut self, path: &ExprPath) -> Result<Value> {
        if path.path.is_ident("self") {
            return Ok(Value::System);
        }
        if let Some(name) = path.path.get_ident() {
            match self.local(name) {
                Some(Value::Import(path)) => return Ok(Value::Written(Written::leaf(path.clone()))),
                Some(value) => return Ok(value.clone()),
                None => {}
            }
        }
        let Some(last) = path.path.segments.last() else {
            return refuse(path, "not a name");
        };
        let name = last.ident.clone();
        let first = &path.path.segments[0].ident;
        let of_block = path.qself.is_none()
            && path.path.leading_colon.is_none()
            && path.path.segments.len() == 2
            && (first == "Self" || *first == *self.source.name());
        if of_block && self.function(&name).is_some() {
            return Ok(Value::Function(name));
        }
        if of_block && let Some(constant) = self.block_constant(&name) {
            return Ok(constant);
        }
        let spelled = name.to_string();
        let is_constant = spelled.contains(char::is_uppercase) && !spelled.contains(char::is_lowercase);
        // A variant, such as `Law::Linear`.
        let is_variant = path.path.segments.len() > 1 && spelled.starts_with(char::is_uppercase);
        if is_constant || is_variant {
            let path = self.imported(path);
            return Ok(Value::Written(Written::leaf(path)));
        }
        if path.path.segments.len() == 2 && *first == self.scalar {
            return Ok(Value::Method(name));
        }
        refuse(
            path,
            format!(
                "`{name}` is not known here; use locals, fields, constants and functions of the annotated block"
            ),
        )
    }

    /// The path as it reads outside the body: `consts::PI` after `use std::f64::consts;`.
    fn imported(&self, path: &ExprPath) -> TokenStream {
        let first = &path.path.segments[0].ident;
        if path.path.segments.len() > 1
            && path.path.leading_colon.is_none()
            && let Some(Value::Import(module)) = self.local(first)
        {
            let rest = path.path.segments.iter().skip(1);
            return quote!(#module #(:: #rest)*);
        }
        path.to_token_stream()
    }

    fn unary(&mut self, unary: &ExprUnary) -> Result<Value> {
        let value = self.expression(&unary.expr)?;
        self.apply_unary(unary, value)
    }

    fn apply_unary(&mut self, unary: &ExprUnary, value: Value) -> Result<Value> {
        match (&unary.op, value) {
            (UnOp::Deref(_), Value::Written(written)) => Ok(Value::Written(written.dereferenced())),
            (UnOp::Deref(_), value) => Ok(value),
            (UnOp::Neg(_), Value::Integer(integer)) => self.negated(unary, integer),
            (UnOp::Not(_), Value::Integer(integer)) => self.complement(unary, integer),
            (operator, Value::Written(written)) => {
                Ok(Value::Written(Written::Unary(*operator, Box::new(written))))
            }
            (_, Value::Chosen(chosen)) => {
                self.distribute(unary, &chosen, |this, value| this.apply_unary(unary, value))
            }
            (UnOp::Neg(_), value) => {
                let node = self.scalar(unary, value)?;
                Ok(Value::Real(match self.graph.constant_value(node) {
                    Some(value) => self.graph.constant(-value),
                    None => self.graph.node(Operation::Negate(node)),
                }))
            }
            (UnOp::Not(_), Value::Truth(truth)) => Ok(Value::Truth(truth.not(&mut self.graph))),
            _ => refuse(unary, "this operator cannot be followed at compile time"),
        }
    }

    fn binary(&mut self, binary: &ExprBinary) -> Result<Value> {
        let ExprBinary { left, op, right, .. } = binary;
        if let BinOp::And(_) | BinOp::Or(_) = op {
            let left_value = self.expression(left)?;
            let is_and = matches!(op, BinOp::And(_));
            let right_side = |this: &mut Self| {
                let value = this.expression(right)?;
                this.truth(right, value).map(Value::Truth)
            };
            return match self.truth(left, left_value)? {
                // The right side of a decided condition is not run.
                Truth::Known(a) if a != is_and => {
                    self.integers.has_dead_code = true;
                    Ok(Value::Truth(Truth::Known(a)))
                }
                Truth::Known(_) => right_side(self),
                Truth::Where(a) => {
                    let decided = |_: &mut Self| Ok(Value::Truth(Truth::Known(!is_and)));
                    self.both(binary, a, is_and, right_side, decided)
                }
            };
        }
        if let Some(operator) = plain(op) {
            // Rust evaluates the right side of a compound assignment to a number first.
            let right_value = self.expression(right)?;
            let place = self.place(left)?;
            let left_value = self.read(left, &place)?;
            let value = self.operate(binary, &operator, left_value, right_value)?;
            return self.write(left, &place, value);
        }
        let (left, right) = (self.expression(left)?, self.expression(right)?);
        self.operate(binary, op, left, right)
    }

    /// `left && right` or `left || right`, where numbers decide whether the right side is run.
    fn both(
        &mut self,
        at: &ExprBinary,
        left: Node,
        is_and: bool,
        right: impl FnOnce(&mut Self) -> Result<Value>,
        decided: impl FnOnce(&mut Self) -> Result<Value>,
    ) -> Result<Value> {
        // As written, and not as a selection between `true` and the other.
        let value = if is_and {
            self.branch_values(at, left, right, decided)?.0
        } else {
            self.branch_values(at, left, decided, right)?.1
        };
        let Value::Truth(right) = value else { return refuse(at, "this is not a condition") };
        let (left, graph) = (Truth::Where(left), &mut self.graph);
        Ok(Value::Truth(if is_and { left.and(graph, right) } else { left.or(graph, right) }))
    }

    /// `left operator right`.
    pub fn operate(&mut self, at: &ExprBinary, operator: &BinOp, left: Value, right: Value) -> Result<Value> {
        match (left, right) {
            (Value::Integer(a), Value::Integer(b)) => self.integers(at, operator, a, b),
            (Value::Truth(a), Value::Truth(b)) => self.truths(at, operator, a, b),
            (Value::Truth(a), Value::Written(b)) => {
                let b = self.written_truth(&at.right, &b)?;
                self.truths(at, operator, a, Truth::Where(b))
            }
            (Value::Written(a), Value::Truth(b)) => {
                let a = self.written_truth(&at.left, &a)?;
                self.truths(at, operator, Truth::Where(a), b)
            }
            // Fields and constants alone: what they are, rustc knows.
            (Value::Written(a), Value::Written(b)) => {
                Ok(Value::Written(Written::Binary(*operator, Box::new(a), Box::new(b))))
            }
            (Value::Written(a), Value::Integer(b)) => {
                let b = Box::new(self.literal_of(b, operator));
                Ok(Value::Written(Written::Binary(*operator, Box::new(a), b)))
            }
            (Value::Integer(a), Value::Written(b)) => {
                let a = Box::new(self.literal_of(a, operator));
                Ok(Value::Written(Written::Binary(*operator, a, Box::new(b))))
            }
            (Value::Chosen(a), b @ (Value::Integer(_) | Value::Written(_) | Value::Chosen(_))) => {
                self.distribute(at, &a, |this, a| this.operate(at, operator, a, b.clone()))
            }
            (a @ (Value::Integer(_) | Value::Written(_)), Value::Chosen(b)) => {
                self.distribute(at, &b, |this, b| this.operate(at, operator, a.clone(), b))
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

    /// An operator of bools that evaluates both sides.
    fn truths(&mut self, at: &ExprBinary, operator: &BinOp, a: Truth, b: Truth) -> Result<Value> {
        let graph = &mut self.graph;
        let truth = match operator {
            BinOp::BitAnd(_) => a.and(graph, b),
            BinOp::BitOr(_) => a.or(graph, b),
            BinOp::BitXor(_) | BinOp::Ne(_) => a.differs(graph, b),
            BinOp::Eq(_) => a.differs(graph, b).not(graph),
            _ => return refuse(at, "combine conditions with `&&`, `||`, `!`, `==` and `!=`"),
        };
        Ok(Value::Truth(truth))
    }

    /// An integer beside a field: its type is the field's.
    fn literal_of(&mut self, integer: Integer, operator: &BinOp) -> Written {
        if !matches!(operator, BinOp::Shl(_) | BinOp::Shr(_)) {
            self.beside_field(integer);
        }
        literal(integer)
    }

    /// The integer with its type, which rustc must know before it finds a method.
    pub fn typed_literal(&self, integer: Integer) -> Written {
        match self.integers.type_of(integer.class) {
            Some(ty) => {
                let digits =
                    syn::LitInt::new(&format!("{}_{ty}", integer.value.unsigned_abs()), Span::call_site());
                Written::leaf(if integer.value < 0 { quote!((-#digits)) } else { quote!(#digits) })
            }
            None => literal(integer),
        }
    }

    fn field(&mut self, at: &Expr, base: Value, member: &Member) -> Result<Value> {
        match (base, member) {
            (Value::System, member) => {
                // Without parentheses, as in `(*self).k`.
                let word = proc_macro2::Ident::new("self", super::span_of(at));
                Ok(Value::Written(Written::leaf(quote!(#word.#member))))
            }
            (Value::Written(base), member) => {
                Ok(Value::Written(base.derived(false, |base| quote!(#base.#member))))
            }
            (Value::Tuple(entries), Member::Unnamed(index)) if (index.index as usize) < entries.len() => {
                Ok(entries[index.index as usize].clone())
            }
            (Value::Chosen(chosen), member) => {
                self.distribute(member, &chosen, |this, base| this.field(at, base, member))
            }
            _ => refuse(member, "this member is not known here"),
        }
    }

    pub fn entry(&mut self, at: &impl ToTokens, base: Value, index: Value) -> Result<Value> {
        match (base, index) {
            (base, Value::Chosen(index)) => {
                self.distribute(at, &index, |this, index| this.entry(at, base.clone(), index))
            }
            (Value::Sequence(entries), Value::Integer(index)) => match entries.get(self.size(at, index)?) {
                Some(entry) => Ok(entry.clone()),
                None => refuse(
                    at,
                    format!("index {} is outside an array of length {}", index.value, entries.len()),
                ),
            },
            (Value::Written(array), Value::Integer(index)) => {
                let index = self.size(at, index)?;
                Ok(Value::Written(array.entry(index)))
            }
            (Value::Written(array), Value::Written(index)) => {
                let both = Written::Binary(
                    BinOp::Eq(Default::default()),
                    Box::new(array.clone()),
                    Box::new(index.clone()),
                );
                // One text within the arms of both.
                let Written::Leaf(mut leaf) = both.derived(true, |_| TokenStream::new()) else {
                    return refuse(at, "this index is not known at compile time");
                };
                let Written::Leaf(array) = array.derived(false, |array| array) else {
                    return refuse(at, "this index is not known at compile time");
                };
                let (array, index) = (array.tokens, self.text(at, &index)?.tokens);
                leaf.tokens = quote!(#array[#index]);
                Ok(Value::Written(Written::Leaf(leaf)))
            }
            (Value::Chosen(base), index) => {
                self.distribute(at, &base, |this, base| this.entry(at, base, index.clone()))
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
        let (start, end) = self.bounds(range, Some(entries.len()))?;
        let mut ends = Vec::new();
        for bound in [start, end] {
            ends.push(self.size(range, bound)?);
        }
        if ends[1] < ends[0] || ends[1] > entries.len() {
            return refuse(range, "this range leaves the array");
        }
        Ok(Value::Sequence(entries[ends[0]..ends[1]].to_vec()))
    }

    fn range(&mut self, range: &ExprRange) -> Result<Value> {
        if range.end.is_none() {
            return refuse(range, "a range without an end; write the end out");
        }
        let (start, end) = self.bounds(range, None)?;
        if end.value - start.value > super::MAX_NODES as i128 {
            return refuse(range, "the loops, written out, are too long for straight-line code");
        }
        Ok(Value::Sequence(
            (start.value..end.value)
                .map(|value| Value::Integer(Integer { value, class: start.class }))
                .collect(),
        ))
    }

    /// The first index of a range, and the one behind the last.
    fn bounds(&mut self, range: &ExprRange, length: Option<usize>) -> Result<(Integer, Integer)> {
        let start = range.start.as_deref().map(|start| self.bound(start)).transpose()?;
        let end = range.end.as_deref().map(|end| self.bound(end)).transpose()?;
        let is_closed = matches!(range.limits, RangeLimits::Closed(_));
        if let (Some(start), Some(end)) = (start, end) {
            self.unify(start.class, end.class)?;
        }
        let known = |this: &mut Self, value: usize| match this.integer(range, value as i128, None)? {
            Value::Integer(integer) => Ok(integer),
            _ => refuse(range, "a range of something that is no integer"),
        };
        let start = match start {
            Some(start) => start,
            None => known(self, 0)?,
        };
        let mut end = match end {
            Some(end) => end,
            None => known(self, length.unwrap_or_default())?,
        };
        // A closed range ends at its last value, and computes none behind it.
        end.value += i128::from(is_closed && range.end.is_some());
        Ok((start, end))
    }

    fn bound(&mut self, bound: &Expr) -> Result<Integer> {
        match self.expression(bound)? {
            Value::Integer(value) => Ok(value),
            _ => refuse(
                bound,
                "this bound is not known at compile time; use a literal, a constant of the annotated block or `q.len()`",
            ),
        }
    }

    fn cast(&mut self, cast: &ExprCast) -> Result<Value> {
        // Of literals: rustc rounds.
        if is_plain(&cast.expr) && simple_name(&cast.ty).is_none_or(|name| *name != self.scalar) {
            return Ok(Value::Written(Written::leaf(quote!((#cast)))));
        }
        let value = self.expression(&cast.expr)?;
        self.cast_value(cast, value)
    }

    fn cast_value(&mut self, cast: &ExprCast, value: Value) -> Result<Value> {
        let ty = &cast.ty;
        let is_scalar = simple_name(ty).is_some_and(|name| *name == self.scalar);
        match (value, IntegerType::of(ty)) {
            (Value::Integer(integer), Some(ty)) => self.integer_cast(cast, integer.value, ty),
            (Value::Integer(integer), None) if is_scalar => Ok(self.converted(integer)),
            (Value::Real(node), None) if is_scalar => Ok(Value::Real(node)),
            // Another precision than the system's: rustc rounds.
            (Value::Integer(integer), None)
                if simple_name(ty).is_some_and(|name| name == "f64" || name == "f32") =>
            {
                let exact = proc_macro2::Literal::i128_suffixed(integer.value.abs());
                let sign = (integer.value < 0).then(|| quote!(-));
                Ok(Value::Written(Written::leaf(quote!((#sign #exact as #ty)))))
            }
            (Value::Truth(truth), Some(ty)) => {
                let number = |this: &mut Self, truth| this.integer(cast, i128::from(truth), Some(ty));
                match truth {
                    Truth::Known(truth) => number(self, truth),
                    Truth::Where(condition) => {
                        let (one, zero) = (number(self, true)?, number(self, false)?);
                        self.select(cast, condition, one, zero)
                    }
                }
            }
            (Value::Written(written), _) => {
                Ok(Value::Written(written.derived(false, |operand| quote!((#operand as #ty)))))
            }
            (Value::Chosen(chosen), _) => {
                self.distribute(cast, &chosen, |this, value| this.cast_value(cast, value))
            }
            _ => refuse(
                cast,
                "only integers can be cast here, to an integer or to the scalar of the system; to choose between cases, compare: `if q[0] > 0.0 { … } else { … }`",
            ),
        }
    }

    /// The nearest floating-point number.
    fn converted(&mut self, integer: Integer) -> Value {
        #[expect(clippy::cast_precision_loss, reason = "this is Rust's `as`")]
        let nearest =
            if self.scalar == "f32" { f64::from(integer.value as f32) } else { integer.value as f64 };
        self.number(nearest)
    }

    fn path_call(&mut self, call: &ExprCall, length: Option<usize>) -> Result<Value> {
        if let Expr::Path(path) = &*call.func {
            let segments: Vec<String> =
                path.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
            match segments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
                [.., "array", "from_fn"] => return self.array_from_fn(call, length),
                ["f64" | "f32", "from"] if call.args.len() == 1 => {
                    let value = self.expression(&call.args[0])?;
                    return self.float_from(call, value);
                }
                [name, "from"] if call.args.len() == 1 && IntegerType::named(name).is_some() => {
                    let value = self.expression(&call.args[0])?;
                    return self.integer_from(call, value, IntegerType::named(name));
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

    /// `f64::from(value)`
    fn float_from(&mut self, call: &ExprCall, value: Value) -> Result<Value> {
        let function = &call.func;
        let is_scalar = matches!(&**function, Expr::Path(path) if path.path.segments[0].ident == self.scalar);
        match value {
            Value::Written(written) => Ok(Value::Written(self.converted_text(call, function, &written)?)),
            Value::Chosen(chosen) => {
                self.distribute(call, &chosen, |this, value| this.float_from(call, value))
            }
            Value::Integer(integer) if is_scalar => Ok(self.converted(integer)),
            Value::Real(node) if is_scalar => Ok(Value::Real(node)),
            Value::Truth(truth) if is_scalar => {
                let (one, zero) = (self.number(1.0), self.number(0.0));
                match truth {
                    Truth::Known(truth) => Ok(if truth { one } else { zero }),
                    Truth::Where(condition) => self.select(call, condition, one, zero),
                }
            }
            _ => refuse(call, "only numbers can be converted here, to the scalar of the system"),
        }
    }

    /// `i64::from(value)`, which loses nothing.
    fn integer_from(&mut self, call: &ExprCall, value: Value, ty: Option<IntegerType>) -> Result<Value> {
        match value {
            Value::Integer(integer) => self.integer(call, integer.value, ty),
            Value::Truth(Truth::Known(truth)) => self.integer(call, i128::from(truth), ty),
            Value::Truth(Truth::Where(condition)) => {
                let (one, zero) = (self.integer(call, 1, ty)?, self.integer(call, 0, ty)?);
                self.select(call, condition, one, zero)
            }
            Value::Written(written) => Ok(Value::Written(self.converted_text(call, &call.func, &written)?)),
            Value::Chosen(chosen) => {
                self.distribute(call, &chosen, |this, value| this.integer_from(call, value, ty))
            }
            _ => refuse(call, "only integers and conditions can be converted here"),
        }
    }

    /// `function(written)`
    fn converted_text(&mut self, at: &ExprCall, function: &Expr, written: &Written) -> Result<Written> {
        self.text(at, written)?;
        Ok(written.derived(false, |operand| quote!(#function(#operand))))
    }

    fn array_from_fn(&mut self, call: &ExprCall, length: Option<usize>) -> Result<Value> {
        let Some(length) = self.said_length(call)?.or(length) else {
            return refuse(
                call,
                "the length is not known here; give the array a type, as in `let a: [f64; 3] = …`",
            );
        };
        let Some(function) = call.args.first() else { return refuse(call, "called without a function") };
        let function = self.expression(function)?;
        let mut entries = Vec::new();
        for index in 0..length {
            let index = self.integer(call, index as i128, Some(IntegerType::USIZE))?;
            entries.push(self.apply(call, &function, vec![index])?);
        }
        Ok(Value::Sequence(entries))
    }

    /// `from_fn::<f64, 3, _>`
    fn said_length(&mut self, call: &ExprCall) -> Result<Option<usize>> {
        let Expr::Path(path) = &*call.func else { return Ok(None) };
        let arguments = path.path.segments.last().map(|segment| &segment.arguments);
        let Some(PathArguments::AngleBracketed(arguments)) = arguments else { return Ok(None) };
        match arguments.args.iter().nth(1) {
            Some(GenericArgument::Const(length)) => self.length(length).map(Some),
            Some(GenericArgument::Type(Type::Infer(_))) => Ok(None),
            Some(other) => refuse(other, "this length is not known here; write a literal"),
            None => Ok(None),
        }
    }
}

/// The integer as it is written.
pub fn literal(integer: Integer) -> Written {
    let digits = proc_macro2::Literal::i128_unsuffixed(integer.value.abs());
    Written::leaf(if integer.value < 0 { quote!((-#digits)) } else { quote!(#digits) })
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
        BinOp::BitAndAssign(_) => BinOp::BitAnd(syn::Token![&](span)),
        BinOp::BitOrAssign(_) => BinOp::BitOr(syn::Token![|](span)),
        BinOp::BitXorAssign(_) => BinOp::BitXor(syn::Token![^](span)),
        BinOp::ShlAssign(_) => BinOp::Shl(syn::Token![<<](span)),
        BinOp::ShrAssign(_) => BinOp::Shr(syn::Token![>>](span)),
        _ => return None,
    })
}
