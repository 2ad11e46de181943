//! Expressions of fields and constants, which the generated code leaves to rustc, evaluated from their
//! tokens.

use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::{BinOp, Expr, Lit, Member, UnOp};

use super::super::interpret::{Exit, Interpreter, Value};
use super::super::number::Number;
use super::super::syntax::{Kind, Operator, Program, Relation};
use super::super::types::{Integer, Type};
use super::Result;

/// The value of an expression.
pub enum Known<S> {
    Real(S),
    Bool(bool),
    Other,
}

/// A value with its type, as far as it is known: the type of a literal is that of the other operand.
struct Typed<S> {
    value: Value<S>,
    ty: Option<Type>,
}

struct Evaluation<'p, S> {
    program: &'p Program,
    interpreter: Interpreter<'p, S>,
}

pub fn evaluate<S: Number>(program: &Program, tokens: TokenStream) -> Result<Known<S>> {
    let expression: Expr = syn::parse2(tokens).map_err(|error| error.to_string())?;
    let interpreter = Interpreter::new(program).map_err(words)?;
    let value = Evaluation { program, interpreter }.of(&expression)?.value;
    Ok(match value {
        Value::Real(x) => Known::Real(x),
        Value::Single(x) => Known::Real(S::constant(f64::from(x))),
        Value::Bool(x) => Known::Bool(x),
        _ => Known::Other,
    })
}

fn words<S>(exit: Exit<S>) -> String {
    match exit {
        Exit::Panic(reason) => reason.to_owned(),
        _ => "a departure".to_owned(),
    }
}

fn kind(ty: &Type) -> Kind {
    match ty {
        Type::Single => Kind::Single,
        Type::Bool => Kind::Bool,
        Type::Integer(ty) => Kind::Integer(*ty),
        _ => Kind::Real,
    }
}

impl<S: Number> Evaluation<'_, S> {
    fn of(&mut self, expression: &Expr) -> Result<Typed<S>> {
        let unknown = || Err(format!("`{}` is not evaluated here", expression.to_token_stream()));
        match expression {
            Expr::Paren(inner) => self.of(&inner.expr),
            Expr::Group(inner) => self.of(&inner.expr),
            Expr::Lit(literal) => self.literal(&literal.lit),
            Expr::Path(path) => {
                let name = path.path.segments.last().map(|last| last.ident.to_string()).unwrap_or_default();
                let (system, constants) = self.interpreter.known();
                if name == "self" {
                    return Ok(Typed { value: system.clone(), ty: None });
                }
                match self.program.constants.iter().position(|constant| constant.name == name) {
                    Some(index) => Ok(Typed {
                        value: constants[index].clone(),
                        ty: Some(self.program.constants[index].ty.clone()),
                    }),
                    None => unknown(),
                }
            }
            Expr::Field(field) => {
                let base = self.of(&field.base)?;
                self.member(base, &field.member)
            }
            Expr::Index(index) => {
                let (base, index) = (self.of(&index.expr)?, self.of(&index.index)?);
                let (Value::Entries(entries), Value::Integer(index)) = (base.value, index.value) else {
                    return unknown();
                };
                let ty = match base.ty {
                    Some(Type::Array(entry, _)) => Some(*entry),
                    _ => None,
                };
                let entry = usize::try_from(index).ok().and_then(|index| entries.into_iter().nth(index));
                Ok(Typed { value: entry.ok_or("an index out of bounds")?, ty })
            }
            Expr::Cast(cast) => {
                let value = self.of(&cast.expr)?.value;
                let name = cast.ty.to_token_stream().to_string();
                let (to, ty) = match (name.as_str(), Integer::named(&name)) {
                    (_, Some(integer)) => (Kind::Integer(integer), Type::Integer(integer)),
                    ("f32", _) if !self.program.single => (Kind::Single, Type::Single),
                    ("f64" | "f32", _) => (Kind::Real, Type::Real),
                    _ => return unknown(),
                };
                Ok(Typed { value: self.interpreter.cast(value, to).map_err(words)?, ty: Some(ty) })
            }
            Expr::Call(call) if call.args.len() == 1 => {
                let name = call.func.to_token_stream().to_string();
                if !name.ends_with(":: from") {
                    return unknown();
                }
                let value = self.of(&call.args[0])?.value;
                let value = self.interpreter.cast(value, Kind::Real).map_err(words)?;
                Ok(Typed { value, ty: Some(Type::Real) })
            }
            Expr::Unary(unary) => {
                let inner = self.of(&unary.expr)?;
                let value = match (&unary.op, inner.value) {
                    (UnOp::Not(_), Value::Bool(x)) => Value::Bool(!x),
                    (UnOp::Neg(_), Value::Integer(x)) => Value::Integer(-x),
                    (UnOp::Neg(_), Value::Real(x)) => Value::Real(x.negated()),
                    (UnOp::Neg(_), Value::Single(x)) => Value::Single(-x),
                    (UnOp::Deref(_), value) => value,
                    _ => return unknown(),
                };
                Ok(Typed { value, ty: inner.ty })
            }
            Expr::Binary(binary) => {
                let a = self.of(&binary.left)?;
                if let (BinOp::And(_) | BinOp::Or(_), Value::Bool(truth)) = (&binary.op, &a.value) {
                    let decided = matches!(binary.op, BinOp::Or(_)) == *truth;
                    return if decided { Ok(a) } else { self.of(&binary.right) };
                }
                let b = self.of(&binary.right)?;
                let ty = match (a.ty, b.ty) {
                    // A shift has the type of its left side.
                    (Some(ty), _) | (None, Some(ty)) => ty,
                    _ => return unknown(),
                };
                if let Some(relation) = relation(&binary.op) {
                    let truth = self.interpreter.compare(relation, &a.value, &b.value);
                    return Ok(Typed { value: Value::Bool(truth), ty: Some(Type::Bool) });
                }
                let Some(operator) = operator(&binary.op) else { return unknown() };
                let value = self.interpreter.operate(operator, kind(&ty), a.value, b.value).map_err(words)?;
                Ok(Typed { value, ty: Some(ty) })
            }
            _ => unknown(),
        }
    }

    fn literal(&mut self, literal: &Lit) -> Result<Typed<S>> {
        Ok(match literal {
            Lit::Bool(truth) => Typed { value: Value::Bool(truth.value), ty: Some(Type::Bool) },
            Lit::Int(integer) => {
                let value = integer.base10_parse().map_err(|error| error.to_string())?;
                let ty = Integer::named(integer.suffix()).map(Type::Integer);
                Typed { value: Value::Integer(value), ty }
            }
            Lit::Float(float) => {
                let value: f64 = float.base10_parse().map_err(|error| error.to_string())?;
                let value = if self.program.single { f64::from(value as f32) } else { value };
                if float.suffix() == "f32" && !self.program.single {
                    Typed { value: Value::Single(value as f32), ty: Some(Type::Single) }
                } else {
                    Typed { value: Value::Real(S::constant(value)), ty: Some(Type::Real) }
                }
            }
            _ => return Err("a literal of another kind".to_owned()),
        })
    }

    fn member(&mut self, base: Typed<S>, member: &Member) -> Result<Typed<S>> {
        let Value::Entries(entries) = base.value else { return Err("a member of no struct".to_owned()) };
        let (index, ty) = match (member, &base.ty) {
            (Member::Unnamed(index), Some(Type::Tuple(types))) => {
                (index.index as usize, types.get(index.index as usize).cloned())
            }
            (Member::Named(name), Some(Type::Struct(of))) => {
                let fields = &self.program.structures[*of].fields;
                let index = fields.iter().position(|(known, _)| name == known).ok_or("no such field")?;
                (index, Some(fields[index].1.clone()))
            }
            (Member::Named(name), None) => {
                let fields = &self.program.fields;
                let index = fields.iter().position(|(known, ..)| name == known).ok_or("no such field")?;
                (index, Some(fields[index].1.clone()))
            }
            _ => return Err("a member of something else".to_owned()),
        };
        let value = entries.into_iter().nth(index).ok_or("no such member")?;
        Ok(Typed { value, ty })
    }
}

fn relation(operator: &BinOp) -> Option<Relation> {
    Some(match operator {
        BinOp::Lt(_) => Relation::Less,
        BinOp::Le(_) => Relation::LessOrEqual,
        BinOp::Gt(_) => Relation::Greater,
        BinOp::Ge(_) => Relation::GreaterOrEqual,
        BinOp::Eq(_) => Relation::Equal,
        BinOp::Ne(_) => Relation::NotEqual,
        _ => return None,
    })
}

fn operator(operator: &BinOp) -> Option<Operator> {
    Some(match operator {
        BinOp::Add(_) => Operator::Add,
        BinOp::Sub(_) => Operator::Subtract,
        BinOp::Mul(_) => Operator::Multiply,
        BinOp::Div(_) => Operator::Divide,
        BinOp::Rem(_) => Operator::Remainder,
        BinOp::BitAnd(_) => Operator::And,
        BinOp::BitOr(_) => Operator::Or,
        BinOp::BitXor(_) => Operator::Xor,
        BinOp::Shl(_) => Operator::ShiftLeft,
        BinOp::Shr(_) => Operator::ShiftRight,
        _ => return None,
    })
}
