//! Integers known at compile time, with the types that Rust gives them.
//!
//! A literal's type follows from its use, often from a later one. Integers that must have one type share a
//! class; the class keeps the extreme values computed in it, which are held against the type once it is
//! known, at the latest when all bodies have been run. A value that its type does not hold panics or wraps by
//! the build: it is refused.

mod arithmetic;

use std::collections::BTreeSet;
use std::rc::Rc;

use quote::ToTokens;

use super::super::diagnostics::span_of;
use super::class::{Class, Integer, IntegerType, Seen};
use super::refusal::one_line;
use super::value::{Chosen, Value};
use super::{Lowering, Result, refuse};

impl Lowering<'_> {
    /// An integer of a known type, or of one that its use will tell.
    pub fn integer(&mut self, at: &impl ToTokens, value: i128, ty: Option<IntegerType>) -> Result<Value> {
        let class = self.integers.fresh(ty);
        self.in_class(at, value, class)
    }

    /// The value as one of the class.
    fn in_class(&mut self, at: &impl ToTokens, value: i128, class: Class) -> Result<Value> {
        let known = self.integers.of_mut(class);
        let is_less = known.least.as_ref().is_none_or(|seen| value < seen.value);
        let is_more = known.most.as_ref().is_none_or(|seen| value > seen.value);
        if is_less || is_more {
            let seen = || Seen { value, span: span_of(at), token: one_line(&at.to_token_stream()) };
            if is_less {
                known.least = Some(seen());
            }
            if is_more {
                known.most = Some(seen());
            }
            self.integers.checked(class)?;
        }
        Ok(Value::Integer(Integer { value, class }))
    }

    /// Tells the type of the class.
    pub fn of_type(&mut self, class: Class, ty: IntegerType) -> Result<()> {
        let typed = self.integers.fresh(Some(ty));
        self.integers.unify(class, typed)
    }

    /// Notes that the integer stands beside something of an unknown type.
    pub fn beside_field(&mut self, integer: Integer) {
        self.integers.of_mut(integer.class).is_beside_field = true;
    }

    /// Makes the types of two values that Rust holds to be of one type one.
    pub fn unify_values(&mut self, a: &Value, b: &Value) -> Result<()> {
        match (a, b) {
            (Value::Integer(a), Value::Integer(b)) => self.integers.unify(a.class, b.class),
            (Value::Integer(a), Value::Written(_)) | (Value::Written(_), Value::Integer(a)) => {
                self.beside_field(*a);
                Ok(())
            }
            (Value::Sequence(a), Value::Sequence(b)) => match (a.first(), b.first()) {
                (Some(a), Some(b)) => self.unify_values(a, b),
                _ => Ok(()),
            },
            (Value::Tuple(a), Value::Tuple(b)) => {
                a.iter().zip(b).try_for_each(|(a, b)| self.unify_values(a, b))
            }
            // Those of one choice are of one type since it was made.
            (Value::Chosen(chosen), other) | (other, Value::Chosen(chosen)) => {
                let one = typed(chosen);
                self.unify_values(&one, other)
            }
            _ => Ok(()),
        }
    }

    /// The type of the class, where an operation cannot do without.
    fn needed_type(&self, at: &impl ToTokens, class: Class) -> Result<IntegerType> {
        match self.integers.of(class).ty {
            Some(ty) => Ok(ty),
            None => refuse(at, "the type of this integer decides the result; write it out, as in `2_u8`"),
        }
    }
}

/// One of the values of a choice: of a type that is known, if one of them is. Each is looked at once, in
/// however many choices it stands.
fn typed(chosen: &Rc<Chosen>) -> Value {
    let (mut open, mut seen) = (vec![Rc::clone(chosen)], BTreeSet::from([Rc::as_ptr(chosen)]));
    let mut written = None;
    while let Some(chosen) = open.pop() {
        for value in [&chosen.a, &chosen.b] {
            match value {
                Value::Chosen(inner) if !seen.insert(Rc::as_ptr(inner)) => {}
                Value::Chosen(inner) => open.push(Rc::clone(inner)),
                Value::Written(_) => written = Some(value.clone()),
                value => return value.clone(),
            }
        }
    }
    written.unwrap_or(Value::Unset)
}
