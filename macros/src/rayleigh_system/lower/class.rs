//! Classes of integers of one type, and the values that a type holds.

use proc_macro2::Span;
use syn::Type;

use super::super::syntax::simple_name;
use super::{Refusal, Result};

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
    pub name: &'static str,
    /// The width; `None` for `usize` and `isize`, whose width is the target's.
    pub bits: Option<u32>,
    pub is_signed: bool,
}

/// The width that `usize` has at least.
pub const LEAST_WIDTH: u32 = 16;

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
    pub const U32: Self = TYPES[8];
    pub const I32: Self = TYPES[2];

    pub fn named(name: &str) -> Option<Self> {
        TYPES.into_iter().find(|ty| ty.name == name)
    }

    /// The type, if it is a primitive integer.
    pub fn of(ty: &Type) -> Option<Self> {
        simple_name(ty).and_then(|name| Self::named(&name.to_string()))
    }

    /// The values that the type holds on every target, as far as they are followed here.
    pub fn range(self) -> (i128, i128) {
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
    pub fn wrapped(self, value: i128) -> Option<i128> {
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
    pub fn saturated(self, value: i128) -> Option<i128> {
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
pub struct Seen {
    pub value: i128,
    pub span: Span,
    pub token: String,
}

/// A class, as far as it is known.
pub struct Known {
    parent: usize,
    pub ty: Option<IntegerType>,
    /// Negated somewhere.
    pub is_signed: bool,
    /// Met something whose type the macro cannot see.
    pub is_beside_field: bool,
    pub least: Option<Seen>,
    pub most: Option<Seen>,
}

/// All classes of one lowering.
#[derive(Default)]
pub struct Classes {
    known: Vec<Known>,
    /// Whether code was left out that might have said more of types.
    pub has_dead_code: bool,
}

impl Classes {
    pub fn fresh(&mut self, ty: Option<IntegerType>) -> Class {
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

    pub fn of(&self, class: Class) -> &Known {
        &self.known[self.root(class)]
    }

    pub fn of_mut(&mut self, class: Class) -> &mut Known {
        let root = self.root(class);
        &mut self.known[root]
    }

    /// Makes two classes one.
    pub fn unify(&mut self, a: Class, b: Class) -> Result<()> {
        let (a, b) = (self.root(a), self.root(b));
        if a == b {
            return Ok(());
        }
        let known = &mut self.known;
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
        self.checked(Class(a))
    }

    /// The name of the type, where it is known.
    pub fn type_of(&self, class: Class) -> Option<&'static str> {
        self.of(class).ty.map(|ty| ty.name)
    }

    /// Refuses what the type of the class does not hold.
    pub fn checked(&self, class: Class) -> Result<()> {
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
