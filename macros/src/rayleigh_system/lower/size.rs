//! How many entries arrays and tuples have: each is a value of its own here.

use quote::ToTokens;
use syn::Type;

use super::value::Value;
use super::{Lowering, Result, refuse};

/// Entries of one value, those of its entries among them. No more operations are written out.
const MAX_ENTRIES: usize = 2 * super::MAX_NODES;

impl Value {
    /// How many values it holds; at most a little more than may be.
    fn entries(&self) -> usize {
        match self {
            Self::Sequence(values) | Self::Tuple(values) => {
                let mut entries = 0;
                for value in values {
                    entries += value.entries();
                    if entries > MAX_ENTRIES {
                        break;
                    }
                }
                entries
            }
            _ => 1,
        }
    }
}

/// Refuses `count` entries of so many values each.
fn bounded(at: &impl ToTokens, count: usize, of_each: usize) -> Result<()> {
    match count.checked_mul(of_each) {
        Some(entries) if entries <= MAX_ENTRIES => Ok(()),
        _ => refuse(at, format!("more than {MAX_ENTRIES} entries are too many for straight-line code")),
    }
}

impl Lowering<'_> {
    /// `count` copies of the value, unless they are too many.
    pub fn repeated(&self, at: &impl ToTokens, value: Value, count: usize) -> Result<Vec<Value>> {
        bounded(at, count, value.entries())?;
        Ok(vec![value; count])
    }

    /// The values as they come, as long as they are not too many.
    pub fn collected(
        &mut self,
        at: &impl ToTokens,
        count: usize,
        mut next: impl FnMut(&mut Self, usize) -> Result<Value>,
    ) -> Result<Vec<Value>> {
        let (mut values, mut entries) = (Vec::new(), 0);
        for index in 0..count {
            let value = next(self, index)?;
            entries += value.entries();
            bounded(at, 1, entries)?;
            values.push(value);
        }
        Ok(values)
    }

    /// The value, unless it has too many entries.
    pub fn of_bounded_size(&self, at: &impl ToTokens, value: Value) -> Result<Value> {
        bounded(at, 1, value.entries())?;
        Ok(value)
    }

    /// How many entries a value of the type has.
    pub fn entries_of(&mut self, ty: &Type) -> Result<usize> {
        match ty {
            Type::Array(array) => {
                let (count, of_each) = (self.length(&array.len)?, self.entries_of(&array.elem)?);
                bounded(&array.len, count, of_each)?;
                Ok(count * of_each)
            }
            Type::Tuple(tuple) => {
                let mut entries = 0;
                for ty in &tuple.elems {
                    entries += self.entries_of(ty)?;
                }
                Ok(entries)
            }
            Type::Paren(inner) => self.entries_of(&inner.elem),
            Type::Group(inner) => self.entries_of(&inner.elem),
            Type::Reference(inner) => self.entries_of(&inner.elem),
            _ => Ok(1),
        }
    }
}
