//! Expressions, each handed on to where its kind is run; literals and paths are run here.

use proc_macro2::TokenStream;
use quote::{ToTokens, quote};
use syn::{Expr, ExprPath, Lit, Type};

use super::class::IntegerType;
use super::place::may_assign;
use super::value::{Truth, Value};
use super::written::Written;
use super::{Lowering, Result, refuse};

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
                self.of_bounded_size(array, Value::Sequence(entries))
            }
            Expr::Repeat(repeat) => {
                let (value, length) = (self.expression(&repeat.expr)?, self.length(&repeat.len)?);
                self.repeated(&repeat.len, value, length).map(Value::Sequence)
            }
            Expr::Tuple(tuple) => {
                let entries =
                    tuple.elems.iter().map(|entry| self.expression(entry)).collect::<Result<_>>()?;
                self.of_bounded_size(tuple, Value::Tuple(entries))
            }
            Expr::Range(range) => self.range(range),
            Expr::Cast(cast) => self.cast(cast),
            Expr::Call(call) => self.path_call(call, None),
            Expr::MethodCall(call) => self.method_call(call),
            Expr::Closure(closure) => Ok(self.closure(closure)),
            Expr::Block(block) => match &block.label {
                None => self.block(&block.block),
                Some(label) => self.labelled_block(label, &block.block),
            },
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
    pub fn number(&mut self, value: f64) -> Value {
        Value::Real(self.graph.constant(value))
    }

    pub fn literal(&mut self, literal: &Lit) -> Result<Value> {
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

    pub fn path(&mut self, path: &ExprPath) -> Result<Value> {
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
        self.constant_of_module(path)
    }

    /// The path as it reads outside the body: `consts::PI` after `use std::f64::consts;`.
    pub fn imported(&self, path: &ExprPath) -> TokenStream {
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
}
