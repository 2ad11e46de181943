//! Shapes that types give to values: the lengths of arrays, the types of integers.

use std::rc::Rc;

use syn::{Expr, ExprLit, Ident, Lit, Type};

use super::super::syntax::simple_name;
use super::class::IntegerType;
use super::value::{Chosen, Value};
use super::{Lowering, MAX_NODES, Result, refuse};

impl Lowering<'_> {
    /// A length in a type: a literal, a constant of the block, or arithmetic on them.
    pub fn length(&mut self, length: &Expr) -> Result<usize> {
        if let Expr::Lit(ExprLit { lit: Lit::Int(literal), .. }) = length
            && let Ok(length) = literal.base10_parse()
        {
            if length > MAX_NODES {
                return refuse(literal, "so long an array is too much for straight-line code");
            }
            return Ok(length);
        }
        let at_length = length;
        match self.expression(length)? {
            Value::Integer(length) if (0..=4096).contains(&length.value) => self.size(at_length, length),
            _ => refuse(
                length,
                "this length is not known here; write a literal, or a constant of the annotated block",
            ),
        }
    }

    /// The value with what its type says of it: an array's length, an integer's type.
    pub fn shaped(&mut self, value: Value, ty: &Type) -> Result<Value> {
        match (value, ty) {
            (value, Type::Reference(reference)) => self.shaped(value, &reference.elem),
            (value, Type::Paren(inner)) => self.shaped(value, &inner.elem),
            (value, Type::Group(inner)) => self.shaped(value, &inner.elem),
            (Value::Integer(integer), ty) => {
                match (IntegerType::of(ty), ty) {
                    (Some(ty), _) => self.of_type(integer.class, ty)?,
                    (None, Type::Infer(_)) => {}
                    // An alias.
                    (None, _) => self.beside_field(integer),
                }
                Ok(Value::Integer(integer))
            }
            (Value::Real(node), ty) if is_of_scalar(ty, &self.scalar) => Ok(Value::Real(node)),
            (Value::Real(_), ty) => refuse(
                ty,
                format!("this system is written in `{}`; write the type out, an alias hides it", self.scalar),
            ),
            (Value::Written(written), Type::Path(_)) => Ok(Value::Written(written.none_of_type(ty))),
            (Value::Written(array), Type::Array(ty)) => {
                self.entries_of(&Type::Array(ty.clone()))?;
                let length = self.length(&ty.len)?;
                let entries = (0..length).map(|index| Value::Written(array.entry(index)));
                entries.map(|entry| self.shaped(entry, &ty.elem)).collect::<Result<_>>().map(Value::Sequence)
            }
            (Value::Written(tuple), Type::Tuple(ty)) => {
                let entries = ty.elems.iter().enumerate();
                entries
                    .map(|(index, ty)| self.shaped(Value::Written(tuple.member(index)), ty))
                    .collect::<Result<_>>()
                    .map(Value::Tuple)
            }
            (Value::Sequence(entries), Type::Array(ty)) => entries
                .into_iter()
                .map(|entry| self.shaped(entry, &ty.elem))
                .collect::<Result<_>>()
                .map(Value::Sequence),
            (Value::Sequence(entries), Type::Slice(ty)) => entries
                .into_iter()
                .map(|entry| self.shaped(entry, &ty.elem))
                .collect::<Result<_>>()
                .map(Value::Sequence),
            (Value::Tuple(entries), Type::Tuple(ty)) if entries.len() == ty.elems.len() => {
                let entries = entries.into_iter().zip(&ty.elems);
                entries.map(|(entry, ty)| self.shaped(entry, ty)).collect::<Result<_>>().map(Value::Tuple)
            }
            (Value::Chosen(chosen), ty) => {
                let a = self.shaped(chosen.a.clone(), ty)?;
                let b = self.shaped(chosen.b.clone(), ty)?;
                Ok(Value::Chosen(Rc::new(Chosen {
                    condition: chosen.condition,
                    a,
                    b,
                    name: chosen.name.clone(),
                })))
            }
            // What is left of a block that has returned.
            (Value::Tuple(entries), _) if entries.is_empty() => Ok(Value::unit()),
            (Value::Sequence(_) | Value::Tuple(_), Type::Path(_) | Type::Macro(_)) => {
                refuse(ty, "write the type out, such as `[f64; 2]`: an alias hides it")
            }
            (value, _) => Ok(value),
        }
    }
}

/// Whether a floating-point number of the body can have this type.
fn is_of_scalar(ty: &Type, scalar: &Ident) -> bool {
    matches!(ty, Type::Infer(_) | Type::ImplTrait(_)) || simple_name(ty).is_some_and(|name| name == scalar)
}
