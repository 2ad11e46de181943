//! Names bound to values, and values assigned to places.

use quote::ToTokens;
use syn::{Expr, Index, Lit, Member, Pat, RangeLimits};

use super::value::{Truth, Value, Written};
use super::{Lowering, Result, refuse};

impl Lowering<'_> {
    /// Binds the names of a pattern.
    pub fn bind(&mut self, pattern: &Pat, value: Value) -> Result<()> {
        match (pattern, value) {
            (Pat::Wild(_), _) => Ok(()),
            (Pat::Ident(pattern), value) if pattern.subpat.is_none() => {
                let name = pattern.ident.to_string();
                let plain = name.trim_start_matches("r#").to_owned();
                let value = match value {
                    Value::Real(node) => {
                        self.graph.give_name(node, &plain);
                        Value::Real(node)
                    }
                    Value::Written(Written::Named(..)) => value,
                    Value::Written(written) => Value::Written(Written::Named(plain, Box::new(written))),
                    value => value,
                };
                self.locals.push((name, value));
                Ok(())
            }
            (Pat::Paren(inner), value) => self.bind(&inner.pat, value),
            (Pat::Type(typed), value) => {
                let value = self.shaped(value, &typed.ty)?;
                self.bind(&typed.pat, value)
            }
            (Pat::Reference(inner), value) => self.bind(&inner.pat, value),
            (Pat::Tuple(tuple), Value::Tuple(values)) if tuple.elems.len() == values.len() => {
                tuple.elems.iter().zip(values).try_for_each(|(pattern, value)| self.bind(pattern, value))
            }
            (Pat::Tuple(tuple), Value::Written(values)) => tuple
                .elems
                .iter()
                .enumerate()
                .try_for_each(|(index, pattern)| self.bind(pattern, Value::Written(values.member(index)))),
            (Pat::Slice(slice), Value::Sequence(values)) if slice.elems.len() == values.len() => {
                slice.elems.iter().zip(values).try_for_each(|(pattern, value)| self.bind(pattern, value))
            }
            (Pat::Slice(slice), Value::Written(values))
                if !slice.elems.iter().any(|pattern| matches!(pattern, Pat::Rest(_))) =>
            {
                slice
                    .elems
                    .iter()
                    .enumerate()
                    .try_for_each(|(index, pattern)| self.bind(pattern, Value::Written(values.entry(index))))
            }
            (pattern, _) => {
                refuse(pattern, "this pattern cannot be followed here; use names, tuples and arrays")
            }
        }
    }

    /// Whether a known value matches the pattern of a `match` arm.
    pub fn matches(&mut self, pattern: &Pat, value: &Value) -> Result<bool> {
        match (pattern, value) {
            (Pat::Wild(_), _) => Ok(true),
            (Pat::Ident(name), _) if name.subpat.is_none() => Ok(true),
            (Pat::Or(or), value) => {
                for pattern in &or.cases {
                    if self.matches(pattern, value)? {
                        return Ok(true);
                    }
                }
                Ok(false)
            }
            (Pat::Lit(literal), value) => match (&literal.lit, value) {
                (Lit::Int(literal), Value::Integer(value)) => {
                    Ok(literal.base10_parse::<i128>().is_ok_and(|literal| literal == *value))
                }
                (Lit::Bool(literal), Value::Truth(Truth::Known(truth))) => Ok(literal.value == *truth),
                _ => refuse(pattern, "only integers and bools known at compile time can be matched here"),
            },
            (Pat::Range(range), Value::Integer(value)) => {
                let mut known = |bound: &Expr| match self.expression(bound)? {
                    Value::Integer(bound) => Ok(bound),
                    _ => refuse(bound, "only integers can bound a pattern here"),
                };
                let above =
                    range.start.as_deref().map(&mut known).transpose()?.is_none_or(|start| *value >= start);
                let end = range.end.as_deref().map(&mut known).transpose()?;
                let closed = matches!(range.limits, RangeLimits::Closed(_));
                Ok(above && end.is_none_or(|end| if closed { *value <= end } else { *value < end }))
            }
            (Pat::Tuple(tuple), Value::Tuple(values)) if tuple.elems.len() == values.len() => {
                for (pattern, value) in tuple.elems.iter().zip(values) {
                    if !self.matches(pattern, value)? {
                        return Ok(false);
                    }
                }
                Ok(true)
            }
            _ => refuse(pattern, "only integers and bools known at compile time can be matched here"),
        }
    }

    /// `place = value`.
    pub fn assign(&mut self, place: &Expr, value: Value) -> Result<Value> {
        let mut steps = Vec::new();
        let name = self.place(place, &mut steps)?;
        let position = self.locals.iter().rposition(|(known, _)| *known == name);
        let Some(position) = position else {
            return refuse(place, "only locals can be assigned to");
        };
        if position < self.captured {
            return refuse(
                place,
                "a closure cannot change a local of its surroundings here; use a `for` loop, or `fold`",
            );
        }
        let mut target = &mut self.locals[position].1;
        for step in steps {
            target = match target {
                Value::Sequence(entries) | Value::Tuple(entries) if step < entries.len() => {
                    &mut entries[step]
                }
                _ => {
                    return refuse(
                        place,
                        "the entries of this place are not known here; give it a type, as in `let mut a: [f64; 3] = …`",
                    );
                }
            };
        }
        *target = value;
        Ok(Value::unit())
    }

    /// The local that a place belongs to, and the way from there.
    fn place(&mut self, place: &Expr, steps: &mut Vec<usize>) -> Result<String> {
        match place {
            Expr::Path(path) if path.path.get_ident().is_some() => {
                Ok(path.path.to_token_stream().to_string())
            }
            Expr::Paren(inner) => self.place(&inner.expr, steps),
            Expr::Group(inner) => self.place(&inner.expr, steps),
            Expr::Index(index) => {
                let name = self.place(&index.expr, steps)?;
                match self.expression(&index.index)? {
                    Value::Integer(value) if value >= 0 => steps.push(value as usize),
                    _ => return refuse(&index.index, "this index is not known at compile time"),
                }
                Ok(name)
            }
            Expr::Field(field) => {
                let name = self.place(&field.base, steps)?;
                match &field.member {
                    Member::Unnamed(Index { index, .. }) => steps.push(*index as usize),
                    member => return refuse(member, "only locals can be assigned to"),
                }
                Ok(name)
            }
            other => refuse(other, "only locals and their entries can be assigned to"),
        }
    }
}
