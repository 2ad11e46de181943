//! Integers with the semantics of Rust: what overflows panics, what wraps wraps.

use super::super::number::Number;
use super::super::syntax::Operator;
use super::super::types::Integer;
use super::{Exit, Result, Value};

const OVERFLOW: &str = "an overflow";
const BEYOND: &str = "beyond an i128";

fn held<S>(ty: Integer, value: Option<i128>) -> Result<S, i128> {
    value.filter(|value| ty.holds(*value)).ok_or(Exit::Panic(OVERFLOW))
}

fn wrapped<S>(ty: Integer, value: Option<i128>) -> Result<S, i128> {
    value.and_then(|value| ty.wrapped(value)).ok_or(Exit::Panic(BEYOND))
}

pub fn operate<S: Number>(operator: Operator, ty: Integer, a: i128, b: i128) -> Result<S> {
    let shift = || -> Result<S, u32> {
        u32::try_from(b).ok().filter(|b| *b < ty.bits).ok_or(Exit::Panic("a shift too far"))
    };
    let result = match operator {
        Operator::Add => held(ty, a.checked_add(b))?,
        Operator::Subtract => held(ty, a.checked_sub(b))?,
        Operator::Multiply => held(ty, a.checked_mul(b))?,
        Operator::Divide => held(ty, a.checked_div(b))?,
        // The quotient of the least value by −1 overflows, and so does the remainder.
        Operator::Remainder if b == -1 && a == ty.least() => return Err(Exit::Panic(OVERFLOW)),
        Operator::Remainder => held(ty, a.checked_rem(b))?,
        Operator::And => a & b,
        Operator::Or => a | b,
        Operator::Xor => a ^ b,
        Operator::ShiftLeft => {
            let shift = shift()?;
            // The bits that leave are lost.
            let kept =
                if ty.bits == 128 { a.checked_mul(1 << shift.min(126)) } else { Some(a << shift.min(63)) };
            wrapped(ty, kept.filter(|_| shift < 64))?
        }
        Operator::ShiftRight => a >> shift()?,
    };
    Ok(Value::Integer(result))
}

/// A float cut to an integer, kept within its bounds; 0 for NaN.
pub fn truncated<S>(x: f64, ty: Integer) -> Result<S, i128> {
    if ty.bits == 128 && !ty.signed && x > 1e38 {
        return Err(Exit::Panic(BEYOND));
    }
    Ok((x as i128).clamp(ty.least(), ty.greatest()))
}

pub fn method<S: Number>(name: &str, ty: Integer, arguments: &[i128]) -> Result<S> {
    let a = arguments[0];
    let b = arguments.get(1).copied().unwrap_or(0);
    let power = || u32::try_from(b).ok().and_then(|n| a.checked_pow(n));
    let clamped = |value: Option<i128>, up: bool| {
        Ok(match value {
            Some(value) => value.clamp(ty.least(), ty.greatest()),
            // Beyond an i128: only 128-bit types get there, and their bound is meant, unless it is that of
            // u128.
            None if ty.signed => {
                if up {
                    ty.greatest()
                } else {
                    ty.least()
                }
            }
            None => return Err(Exit::Panic(BEYOND)),
        })
    };
    // The bounds of u128 are beyond those tried.
    if ty.bits == 128 && !ty.signed && name.starts_with("saturating") && name != "saturating_sub" {
        return Err(Exit::Panic(BEYOND));
    }
    let result = match name {
        "pow" => held(ty, power())?,
        "abs" => held(ty, a.checked_abs())?,
        "signum" => a.signum(),
        "min" => a.min(b),
        "max" => a.max(b),
        "clamp" => {
            if b > arguments[2] {
                return Err(Exit::Panic("clamp"));
            }
            a.clamp(b, arguments[2])
        }
        "abs_diff" => a.checked_sub(b).and_then(i128::checked_abs).ok_or(Exit::Panic(BEYOND))?,
        "rem_euclid" | "div_euclid" if b == 0 => return Err(Exit::Panic("a division by zero")),
        "rem_euclid" | "div_euclid" if b == -1 && a == ty.least() => return Err(Exit::Panic(OVERFLOW)),
        "rem_euclid" => a.rem_euclid(b),
        "div_euclid" => a.div_euclid(b),
        "wrapping_add" => wrapped(ty, a.checked_add(b))?,
        "wrapping_sub" => wrapped(ty, a.checked_sub(b))?,
        "wrapping_mul" => wrapped(ty, a.checked_mul(b))?,
        "wrapping_neg" => wrapped(ty, a.checked_neg())?,
        "saturating_add" => clamped(a.checked_add(b), b > 0)?,
        "saturating_sub" => clamped(a.checked_sub(b), b < 0)?,
        "saturating_mul" => clamped(a.checked_mul(b), (a < 0) == (b < 0))?,
        "count_ones" => {
            let low = if ty.bits == 128 { a as u128 } else { (a as u128) & ((1 << ty.bits) - 1) };
            i128::from(low.count_ones())
        }
        _ => unreachable!("the generator writes no method `{name}`"),
    };
    Ok(Value::Integer(result))
}
