//! Operators, casts and methods of integers.

use proc_macro2::Ident;
use quote::ToTokens;
use syn::{BinOp, LitInt};

use super::super::class::{Integer, IntegerType, LEAST_WIDTH};
use super::super::value::{Truth, Value};
use super::super::{Lowering, Result, refuse};

impl Lowering<'_> {
    /// `left operator right` of integers.
    pub fn integers(
        &mut self,
        at: &impl ToTokens,
        operator: &BinOp,
        left: Integer,
        right: Integer,
    ) -> Result<Value> {
        let (a, b) = (left.value, right.value);
        if let BinOp::Shl(_) | BinOp::Shr(_) = operator {
            return self.shifted(at, operator, left, right);
        }
        self.integers.unify(left.class, right.class)?;
        let known = |truth| Ok(Value::Truth(Truth::Known(truth)));
        let result = match operator {
            BinOp::Add(_) => a.checked_add(b),
            BinOp::Sub(_) => a.checked_sub(b),
            BinOp::Mul(_) => a.checked_mul(b),
            BinOp::Div(_) | BinOp::Rem(_) if b == 0 => return refuse(at, "a division by 0"),
            BinOp::Div(_) => a.checked_div(b),
            BinOp::Rem(_) => {
                // The least number of a type has no remainder by −1.
                if b == -1 {
                    self.negated(at, left)?;
                }
                a.checked_rem(b)
            }
            BinOp::BitAnd(_) => Some(a & b),
            BinOp::BitOr(_) => Some(a | b),
            BinOp::BitXor(_) => Some(a ^ b),
            BinOp::Lt(_) => return known(a < b),
            BinOp::Le(_) => return known(a <= b),
            BinOp::Gt(_) => return known(a > b),
            BinOp::Ge(_) => return known(a >= b),
            BinOp::Eq(_) => return known(a == b),
            BinOp::Ne(_) => return known(a != b),
            _ => None,
        };
        match result {
            Some(value) => self.in_class(at, value, left.class),
            None => refuse(at, "this integer cannot be computed at compile time"),
        }
    }

    fn shifted(
        &mut self,
        at: &impl ToTokens,
        operator: &BinOp,
        left: Integer,
        right: Integer,
    ) -> Result<Value> {
        let ty = self.integers.of(left.class).ty;
        // The narrowest type that it may have.
        let width = match ty {
            Some(ty) => i128::from(ty.bits.unwrap_or(LEAST_WIDTH)),
            None => 8,
        };
        if !(0..width.min(64)).contains(&right.value) {
            return refuse(
                at,
                "a shift by as many bits as the type has overflows; write the type out if it has more",
            );
        }
        let value = match operator {
            BinOp::Shl(_) => left.value.checked_mul(1 << right.value),
            _ => Some(left.value >> right.value),
        };
        let value = match ty {
            Some(ty) => value.and_then(|value| ty.wrapped(value)),
            None => value,
        };
        match value {
            Some(value) => self.in_class(at, value, left.class),
            None => refuse(at, "this integer cannot be computed at compile time"),
        }
    }

    /// `-value`
    pub fn negated(&mut self, at: &impl ToTokens, integer: Integer) -> Result<Value> {
        self.integers.of_mut(integer.class).is_signed = true;
        match integer.value.checked_neg() {
            Some(value) => self.in_class(at, value, integer.class),
            None => refuse(at, "this integer cannot be computed at compile time"),
        }
    }

    /// A literal with its sign: the least number of a type, `-128_i8`, has no opposite there. `None` where it
    /// is no integer.
    pub fn negative_literal(&mut self, at: &impl ToTokens, literal: &LitInt) -> Option<Result<Value>> {
        let ty = IntegerType::named(literal.suffix());
        if ty.is_none() && !literal.suffix().is_empty() {
            return None;
        }
        let size = literal.base10_parse().ok()?;
        let value = 0_i128.checked_sub_unsigned(size)?;
        let class = self.integers.fresh(ty);
        self.integers.of_mut(class).is_signed = true;
        Some(self.in_class(at, value, class))
    }

    /// `!value`
    pub fn complement(&mut self, at: &impl ToTokens, integer: Integer) -> Result<Value> {
        let ty = self.needed_type(at, integer.class)?;
        match (ty.is_signed, ty.bits) {
            (true, _) => self.in_class(at, !integer.value, integer.class),
            (false, Some(bits)) if bits < 128 => {
                self.in_class(at, ty.range().1 - integer.value, integer.class)
            }
            _ => refuse(at, "the width of this type decides the result"),
        }
    }

    /// `value as ty`
    pub fn integer_cast(&mut self, at: &impl ToTokens, value: i128, ty: IntegerType) -> Result<Value> {
        match ty.wrapped(value) {
            Some(value) => self.integer(at, value, Some(ty)),
            None => refuse(at, format!("what {value} becomes as `{}` depends on the target", ty.name)),
        }
    }

    /// A method of an integer.
    pub fn integer_method(&mut self, method: &Ident, integer: Integer, arguments: &[Value]) -> Result<Value> {
        let Integer { value, class } = integer;
        let name = method.to_string();
        let unknown = || -> Result<Value> {
            refuse(method, format!("the method `{method}` of an integer cannot be followed at compile time"))
        };
        let numbers: Vec<Integer> = arguments
            .iter()
            .filter_map(|argument| if let Value::Integer(number) = argument { Some(*number) } else { None })
            .collect();
        if numbers.len() != arguments.len() {
            return unknown();
        }
        if let ("pow" | "wrapping_pow" | "saturating_pow", [exponent]) = (&*name, &numbers[..]) {
            self.of_type(exponent.class, IntegerType::U32)?;
        } else {
            for other in &numbers {
                self.integers.unify(class, other.class)?;
            }
        }
        let others: Vec<i128> = numbers.iter().map(|number| number.value).collect();
        let power = |n: i128| u32::try_from(n).ok().and_then(|n| value.checked_pow(n));
        let result = match (&*name, &others[..]) {
            ("clone", []) => Some(value),
            ("pow", &[n]) => power(n),
            ("min", &[other]) => Some(value.min(other)),
            ("max", &[other]) => Some(value.max(other)),
            ("clamp", &[low, high]) if low <= high => Some(value.clamp(low, high)),
            ("abs", []) => value.checked_abs(),
            ("signum", []) => Some(value.signum()),
            ("rem_euclid", &[other]) if other != 0 => {
                if other == -1 {
                    self.negated(method, integer)?;
                }
                value.checked_rem_euclid(other)
            }
            ("div_euclid", &[other]) if other != 0 => value.checked_div_euclid(other),
            ("abs_diff", &[other]) => {
                let ty = self.needed_type(method, class)?;
                let unsigned = IntegerType::named(&ty.name.replace('i', "u"));
                // `isize` has an `i` of its own.
                let unsigned = if ty.bits.is_none() { Some(IntegerType::USIZE) } else { unsigned };
                return match value.checked_sub(other).and_then(i128::checked_abs) {
                    Some(difference) => self.integer(method, difference, unsigned),
                    None => unknown(),
                };
            }
            _ => {
                let (manner, operation) = name.split_once('_').unwrap_or_default();
                let exact = match (operation, &others[..]) {
                    ("add", &[other]) => value.checked_add(other),
                    ("sub", &[other]) => value.checked_sub(other),
                    ("mul", &[other]) => value.checked_mul(other),
                    ("pow", &[n]) => power(n),
                    _ => return unknown(),
                };
                let ty = self.needed_type(method, class)?;
                match manner {
                    "wrapping" => exact.and_then(|exact| ty.wrapped(exact)),
                    "saturating" => exact.and_then(|exact| ty.saturated(exact)),
                    _ => return unknown(),
                }
            }
        };
        match result {
            Some(value) => self.in_class(method, value, class),
            None => unknown(),
        }
    }

    /// The integer as a length or an index.
    pub fn size(&mut self, at: &impl ToTokens, integer: Integer) -> Result<usize> {
        self.of_type(integer.class, IntegerType::USIZE)?;
        match usize::try_from(integer.value) {
            Ok(size) => Ok(size),
            Err(_) => refuse(at, "a negative length"),
        }
    }
}
