//! Integers known at compile time, with the types that Rust gives them.
//!
//! A literal's type follows from its use, often from a later one. Integers that must have one type share a
//! class; the class keeps the extreme values computed in it, which are held against the type once it is
//! known, at the latest when all bodies have been run. A value that its type does not hold panics or wraps by
//! the build: it is refused.

mod arithmetic;

use std::collections::BTreeSet;
use std::rc::Rc;

use proc_macro2::Span;
use quote::ToTokens;
use syn::Type;

use super::super::diagnostics::span_of;
use super::super::syntax::simple_name;
use super::refusal::one_line;
use super::value::{Chosen, Value};
use super::{Lowering, Refusal, Result, refuse};

/// An integer and the class that its type belongs to.
#[derive(Clone, Copy)]
pub struct Integer {
    pub value: i128,
    pub class: Class,
}

/// Integers of one type.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Class(usize);

/// A primitive integer type.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct IntegerType {
    name: &'static str,
    /// The width; `None` for `usize` and `isize`, whose width is the target's.
    bits: Option<u32>,
    is_signed: bool,
}

/// The width that `usize` has at least.
const LEAST_WIDTH: u32 = 16;

const TYPES: [IntegerType; 12] = {
    const fn of(name: &'static str, bits: Option<u32>, is_signed: bool) -> IntegerType {
        IntegerType { name, bits, is_signed }
    }
    [
        of("i8", Some(8), true),
        of("i16", Some(16), true),
        of("i32", Some(32), true),
        of("i64", Some(64), true),
        of("i128", Some(128), true),
        of("isize", None, true),
        of("u8", Some(8), false),
        of("u16", Some(16), false),
        of("u32", Some(32), false),
        of("u64", Some(64), false),
        of("u128", Some(128), false),
        of("usize", None, false),
    ]
};

impl IntegerType {
    pub const USIZE: Self = TYPES[11];
    const U32: Self = TYPES[8];
    pub const I32: Self = TYPES[2];

    pub fn named(name: &str) -> Option<Self> {
        TYPES.into_iter().find(|ty| ty.name == name)
    }

    /// The type, if it is a primitive integer.
    pub fn of(ty: &Type) -> Option<Self> {
        simple_name(ty).and_then(|name| Self::named(&name.to_string()))
    }

    /// The values that the type holds on every target, as far as they are followed here.
    fn range(self) -> (i128, i128) {
        match (self.is_signed, self.bits.unwrap_or(LEAST_WIDTH)) {
            (true, 128) => (i128::MIN, i128::MAX),
            (true, bits) => (-(1 << (bits - 1)), (1 << (bits - 1)) - 1),
            (false, 128) => (0, i128::MAX),
            (false, bits) => (0, (1 << bits) - 1),
        }
    }

    fn holds(self, value: i128) -> bool {
        let (least, most) = self.range();
        (least..=most).contains(&value)
    }

    /// `value as Self`, unless it depends on the target.
    fn wrapped(self, value: i128) -> Option<i128> {
        if self.holds(value) {
            return Some(value);
        }
        match (self.bits?, self.is_signed) {
            (128, _) => None,
            (bits, is_signed) => {
                let low = value & ((1 << bits) - 1);
                let is_negative = is_signed && low >> (bits - 1) == 1;
                Some(if is_negative { low - (1 << bits) } else { low })
            }
        }
    }

    /// The nearest value, unless it depends on the target.
    fn saturated(self, value: i128) -> Option<i128> {
        let (least, most) = self.range();
        match self.bits {
            Some(128) => self.holds(value).then_some(value),
            Some(_) => Some(value.clamp(least, most)),
            None if value < 0 && !self.is_signed => Some(0),
            None => self.holds(value).then_some(value),
        }
    }
}

/// A value computed in a class, and where.
struct Seen {
    value: i128,
    span: Span,
    token: String,
}

struct Known {
    parent: usize,
    ty: Option<IntegerType>,
    /// Negated somewhere.
    is_signed: bool,
    /// Met something whose type the macro cannot see.
    is_beside_field: bool,
    least: Option<Seen>,
    most: Option<Seen>,
}

/// All classes of one lowering.
#[derive(Default)]
pub struct Classes {
    known: Vec<Known>,
    /// Whether code was left out that might have said more of types.
    pub has_dead_code: bool,
}

impl Classes {
    fn fresh(&mut self, ty: Option<IntegerType>) -> Class {
        let parent = self.known.len();
        self.known.push(Known {
            parent,
            ty,
            is_signed: false,
            is_beside_field: false,
            least: None,
            most: None,
        });
        Class(parent)
    }

    fn root(&self, Class(mut class): Class) -> usize {
        while self.known[class].parent != class {
            class = self.known[class].parent;
        }
        class
    }

    fn of(&self, class: Class) -> &Known {
        &self.known[self.root(class)]
    }

    fn of_mut(&mut self, class: Class) -> &mut Known {
        let root = self.root(class);
        &mut self.known[root]
    }

    /// The name of the type, where it is known.
    pub fn type_of(&self, class: Class) -> Option<&'static str> {
        self.of(class).ty.map(|ty| ty.name)
    }

    /// Refuses what the type of the class does not hold.
    fn checked(&self, class: Class) -> Result<()> {
        let known = self.of(class);
        let Some(ty) = known.ty else { return Ok(()) };
        for seen in [&known.least, &known.most].into_iter().flatten() {
            if !ty.holds(seen.value) {
                let reason = match ty.bits {
                    None => format!("{} overflows `{}` on some target", seen.value, ty.name),
                    Some(_) => format!("{} overflows `{}`", seen.value, ty.name),
                };
                return Err(Refusal { span: seen.span, token: seen.token.clone(), reason, is_final: true });
            }
        }
        Ok(())
    }

    /// Holds what no use gave a type against the types that it may have.
    pub fn settled(&self) -> Result<()> {
        for (index, known) in self.known.iter().enumerate() {
            if known.parent != index || known.ty.is_some() {
                continue;
            }
            let (least, most) = if known.is_beside_field || self.has_dead_code {
                (if known.is_signed { -128 } else { 0 }, 127)
            } else {
                IntegerType::I32.range()
            };
            for seen in [&known.least, &known.most].into_iter().flatten() {
                if !(least..=most).contains(&seen.value) {
                    let reason = format!(
                        "the type of this integer is not known here, and not all types hold {}; write it out, as in `2_i64` or `let n: i64 = …`",
                        seen.value
                    );
                    return Err(Refusal {
                        span: seen.span,
                        token: seen.token.clone(),
                        reason,
                        is_final: false,
                    });
                }
            }
        }
        Ok(())
    }
}

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

    /// Makes two classes one.
    pub fn unify(&mut self, a: Class, b: Class) -> Result<()> {
        let (a, b) = (self.integers.root(a), self.integers.root(b));
        if a == b {
            return Ok(());
        }
        let known = &mut self.integers.known;
        let [ty_a, ty_b] = [known[a].ty, known[b].ty];
        // Otherwise rustc has refused the program already.
        known[a].ty = ty_a.or(ty_b);
        known[a].is_signed |= known[b].is_signed;
        known[a].is_beside_field |= known[b].is_beside_field;
        let (least, most) = (known[b].least.take(), known[b].most.take());
        if least.as_ref().is_some_and(|new| known[a].least.as_ref().is_none_or(|old| new.value < old.value)) {
            known[a].least = least;
        }
        if most.as_ref().is_some_and(|new| known[a].most.as_ref().is_none_or(|old| new.value > old.value)) {
            known[a].most = most;
        }
        known[b].parent = a;
        self.integers.checked(Class(a))
    }

    /// Tells the type of the class.
    pub fn of_type(&mut self, class: Class, ty: IntegerType) -> Result<()> {
        let typed = self.integers.fresh(Some(ty));
        self.unify(class, typed)
    }

    /// Notes that the integer stands beside something of an unknown type.
    pub fn beside_field(&mut self, integer: Integer) {
        self.integers.of_mut(integer.class).is_beside_field = true;
    }

    /// Makes the types of two values that Rust holds to be of one type one.
    pub fn unify_values(&mut self, a: &Value, b: &Value) -> Result<()> {
        match (a, b) {
            (Value::Integer(a), Value::Integer(b)) => self.unify(a.class, b.class),
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
