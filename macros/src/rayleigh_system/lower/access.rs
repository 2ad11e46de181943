//! Fields, entries and ranges of them.

use quote::{ToTokens, quote};
use syn::{Expr, ExprRange, Member, RangeLimits};

use super::super::diagnostics::span_of;
use super::class::Integer;
use super::value::Value;
use super::written::Written;
use super::{Lowering, Result, refuse};

impl Lowering<'_> {
    pub fn field(&mut self, at: &Expr, base: Value, member: &Member) -> Result<Value> {
        match (base, member) {
            (Value::System, member) => {
                // Without parentheses, as in `(*self).k`.
                let word = proc_macro2::Ident::new("self", span_of(at));
                Ok(Value::Written(Written::leaf(quote!(#word.#member))))
            }
            (Value::Written(base), member) => {
                Ok(Value::Written(base.derived(false, |base| quote!(#base.#member))))
            }
            (Value::Tuple(entries), Member::Unnamed(index)) if (index.index as usize) < entries.len() => {
                Ok(entries[index.index as usize].clone())
            }
            (Value::Chosen(chosen), member) => {
                self.distribute(member, &chosen, |this, base| this.field(at, base, member))
            }
            _ => refuse(member, "this member is not known here"),
        }
    }

    pub fn entry(&mut self, at: &impl ToTokens, base: Value, index: Value) -> Result<Value> {
        match (base, index) {
            (base, Value::Chosen(index)) => {
                self.distribute(at, &index, |this, index| this.entry(at, base.clone(), index))
            }
            (Value::Sequence(entries), Value::Integer(index)) => match entries.get(self.size(at, index)?) {
                Some(entry) => Ok(entry.clone()),
                None => refuse(
                    at,
                    format!("index {} is outside an array of length {}", index.value, entries.len()),
                ),
            },
            (Value::Written(array), Value::Integer(index)) => {
                let index = self.size(at, index)?;
                Ok(Value::Written(array.entry(index)))
            }
            (Value::Written(array), Value::Written(index)) => {
                let text = self.text(at, &index)?.tokens;
                Ok(Value::Written(array.entry_at(&index, &text)))
            }
            (Value::Chosen(base), index) => {
                self.distribute(at, &base, |this, base| this.entry(at, base, index.clone()))
            }
            _ => refuse(
                at,
                "this index is not known at compile time; use a literal, a constant of the block or a loop variable",
            ),
        }
    }

    pub fn slice(&mut self, base: Value, range: &ExprRange) -> Result<Value> {
        let Value::Sequence(entries) = base else {
            return refuse(range, "a slice of something whose length is not known here");
        };
        let (start, end) = self.bounds(range, Some(entries.len()))?;
        let mut ends = Vec::new();
        for bound in [start, end] {
            ends.push(self.size(range, bound)?);
        }
        if ends[1] < ends[0] || ends[1] > entries.len() {
            return refuse(range, "this range leaves the array");
        }
        Ok(Value::Sequence(entries[ends[0]..ends[1]].to_vec()))
    }

    pub fn range(&mut self, range: &ExprRange) -> Result<Value> {
        if range.end.is_none() {
            return refuse(range, "a range without an end; write the end out");
        }
        let (start, end) = self.bounds(range, None)?;
        if end.value.saturating_sub(start.value) > super::MAX_NODES as i128 {
            return refuse(range, "the loops, written out, are too long for straight-line code");
        }
        Ok(Value::Sequence(
            (start.value..end.value)
                .map(|value| Value::Integer(Integer { value, class: start.class }))
                .collect(),
        ))
    }

    /// The first index of a range, and the one behind the last.
    fn bounds(&mut self, range: &ExprRange, length: Option<usize>) -> Result<(Integer, Integer)> {
        let start = range.start.as_deref().map(|start| self.bound(start)).transpose()?;
        let end = range.end.as_deref().map(|end| self.bound(end)).transpose()?;
        let is_closed = matches!(range.limits, RangeLimits::Closed(_));
        if let (Some(start), Some(end)) = (start, end) {
            self.integers.unify(start.class, end.class)?;
        }
        let known = |this: &mut Self, value: usize| match this.integer(range, value as i128, None)? {
            Value::Integer(integer) => Ok(integer),
            _ => refuse(range, "a range of something that is no integer"),
        };
        let start = match start {
            Some(start) => start,
            None => known(self, 0)?,
        };
        let mut end = match end {
            Some(end) => end,
            None => known(self, length.unwrap_or_default())?,
        };
        // A closed range ends at its last value, and computes none behind it.
        if is_closed && range.end.is_some() {
            let Some(behind) = end.value.checked_add(1) else {
                return refuse(range, "a closed range to the largest integer; write one that ends before");
            };
            end.value = behind;
        }
        Ok((start, end))
    }

    fn bound(&mut self, bound: &Expr) -> Result<Integer> {
        match self.expression(bound)? {
            Value::Integer(value) => Ok(value),
            _ => refuse(
                bound,
                "this bound is not known at compile time; use a literal, a constant of the annotated block or `q.len()`",
            ),
        }
    }
}
