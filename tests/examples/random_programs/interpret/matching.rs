//! Patterns: whether a value matches, and what they bind.

use super::super::number::Number;
use super::super::syntax::Pattern;
use super::{Interpreter, Value};

impl<S: Number> Interpreter<'_, S> {
    /// Whether the value matches; the names are bound as far as it does, for the caller to drop.
    pub fn matches(&mut self, pattern: &Pattern, value: &Value<S>) -> bool {
        match (pattern, value) {
            (Pattern::Wild, _) => true,
            (Pattern::Name { name, .. }, value) => {
                self.declare(name, value.clone());
                true
            }
            (Pattern::At(name, inner), value) => {
                let matches = self.matches(inner, value);
                self.declare(name, value.clone());
                matches
            }
            (Pattern::Tuple(patterns), Value::Entries(values)) => self.match_all(patterns, values),
            (Pattern::Slice(before, rest, after), Value::Entries(values)) => {
                let named = before.len() + after.len();
                if values.len() < named || (rest.is_none() && values.len() != named) {
                    return false;
                }
                let end = values.len() - after.len();
                if let Some(Some(name)) = rest {
                    self.declare(name, Value::Entries(values[before.len()..end].to_vec()));
                }
                self.match_all(before, values) && self.match_all(after, &values[end..])
            }
            (Pattern::Integer(expected), Value::Integer(value)) => expected == value,
            (Pattern::Bool(expected), Value::Bool(value)) => expected == value,
            (Pattern::Range(low, high, closed), Value::Integer(value)) => {
                low.is_none_or(|low| low <= *value)
                    && high.is_none_or(|high| if *closed { *value <= high } else { *value < high })
            }
            (Pattern::Or(patterns), value) => patterns.iter().any(|pattern| self.matches(pattern, value)),
            (Pattern::Reference(inner), value) => self.matches(inner, value),
            (Pattern::Constant(index), value) => {
                let constant = self.constants[*index].clone();
                self.same(&constant, value)
            }
            (Pattern::Optional(None), Value::Variant(variant, _)) => *variant == 0,
            (Pattern::Optional(Some(inner)), Value::Variant(variant, data)) => {
                *variant == 1 && self.matches(inner, &data[0])
            }
            (Pattern::Variant { variant: expected, data: patterns, .. }, Value::Variant(variant, data)) => {
                expected == variant && self.match_all(patterns, data)
            }
            _ => unreachable!("programs are well typed"),
        }
    }

    fn match_all(&mut self, patterns: &[Pattern], values: &[Value<S>]) -> bool {
        patterns.iter().zip(values).all(|(pattern, value)| self.matches(pattern, value))
    }

    /// Equality of values without floating-point numbers, and of numbers.
    pub fn same(&self, a: &Value<S>, b: &Value<S>) -> bool {
        let all = |a: &[Value<S>], b: &[Value<S>]| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| self.same(a, b))
        };
        match (a, b) {
            (Value::Integer(a), Value::Integer(b)) => a == b,
            (Value::Bool(a), Value::Bool(b)) => a == b,
            (Value::Single(a), Value::Single(b)) => a == b,
            (Value::Real(a), Value::Real(b)) => a.equal(*b),
            (Value::Entries(a), Value::Entries(b)) => all(a, b),
            (Value::Variant(i, a), Value::Variant(j, b)) => i == j && all(a, b),
            _ => unreachable!("programs are well typed"),
        }
    }
}
