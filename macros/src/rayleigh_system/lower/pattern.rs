//! Patterns: names bound to values; in `matching.rs`, whether a value matches.
//!
//! Which of constant, variant and binding a name in a pattern is, rustc alone knows. On fields and constants
//! it decides: the pattern is written out, as `matches!(self.law, Friction::Linear(_))`, and what it binds as
//! a `match` that gives the binding.

pub mod cases;
mod matching;

use std::rc::Rc;

use quote::quote;
use syn::visit::{self, Visit};
use syn::{Ident, Member, Pat, PatIdent, PatStruct, Path};

use super::super::diagnostics::span_of;
use super::value::{Chosen, Value};
use super::written::Written;
use super::{Lowering, Result, refuse};

impl Lowering<'_> {
    /// Binds the names of a pattern that rustc knows to match.
    pub fn bind(&mut self, pattern: &Pat, value: Value) -> Result<()> {
        match (pattern, value) {
            (Pat::Wild(_) | Pat::Rest(_), _) => Ok(()),
            (Pat::Ident(pattern), value) => {
                self.bind_name(&pattern.ident, value.clone());
                match &pattern.subpat {
                    Some((_, inner)) => self.bind(inner, value),
                    None => Ok(()),
                }
            }
            (Pat::Paren(inner), value) => self.bind(&inner.pat, value),
            (Pat::Type(typed), value) => {
                let value = self.shaped(value, &typed.ty)?;
                self.bind(&typed.pat, value)
            }
            (Pat::Reference(inner), Value::Written(written)) => {
                self.bind(&inner.pat, Value::Written(written.dereferenced()))
            }
            (Pat::Reference(inner), value) => self.bind(&inner.pat, value),
            (Pat::Tuple(tuple), Value::Tuple(values)) => {
                for (pattern, range) in parts(pattern, tuple.elems.iter(), values.len())? {
                    self.bind(pattern, values[range.start].clone())?;
                }
                Ok(())
            }
            (Pat::Tuple(tuple), Value::Written(values)) => {
                let elements = tuple.elems.iter().enumerate();
                if tuple.elems.iter().any(|pattern| matches!(pattern, Pat::Rest(_))) {
                    return refuse(
                        pattern,
                        "the length of this tuple is not known here; use `_` for each entry",
                    );
                }
                elements
                    .into_iter()
                    .try_for_each(|(index, pattern)| self.bind(pattern, Value::Written(values.member(index))))
            }
            (Pat::Slice(slice), Value::Sequence(values)) => {
                for (pattern, range) in parts(pattern, slice.elems.iter(), values.len())? {
                    self.bind_part(pattern, &values, range)?;
                }
                Ok(())
            }
            (Pat::Slice(slice), Value::Written(values)) if !slice.elems.iter().any(is_rest) => slice
                .elems
                .iter()
                .enumerate()
                .try_for_each(|(index, pattern)| self.bind(pattern, Value::Written(values.entry(index)))),
            // `let Self { m, k, .. } = self;`
            (Pat::Struct(pattern), Value::System) if self.is_system(&pattern.path) => {
                self.bind_fields(pattern)
            }
            (Pat::Struct(_) | Pat::TupleStruct(_), Value::Written(written)) => {
                let (_, bound) = self.test_written(pattern, &written)?;
                self.locals.extend(bound);
                Ok(())
            }
            (pattern, _) => {
                refuse(pattern, "this pattern cannot be followed here; use names, tuples and arrays")
            }
        }
    }

    fn bind_name(&mut self, ident: &Ident, value: Value) {
        let name = ident.to_string();
        let plain = name.trim_start_matches("r#").to_owned();
        let value = match value {
            Value::Real(node) => {
                self.graph.give_name(node, &plain);
                Value::Real(node)
            }
            Value::Written(Written::Named(..)) => value,
            Value::Written(written) => Value::Written(Written::Named(plain, Box::new(written))),
            Value::Chosen(chosen) if chosen.name.is_none() => {
                let Chosen { condition, a, b, .. } = &*chosen;
                Value::Chosen(Rc::new(Chosen {
                    condition: *condition,
                    a: a.clone(),
                    b: b.clone(),
                    name: Some(plain),
                }))
            }
            value => value,
        };
        self.locals.push((name, value));
    }

    /// An entry, or those that `..` stands for.
    fn bind_part(&mut self, pattern: &Pat, values: &[Value], range: std::ops::Range<usize>) -> Result<()> {
        match pattern {
            Pat::Ident(rest) if rest.subpat.as_ref().is_some_and(|(_, inner)| is_rest(inner)) => {
                self.bind_name(&rest.ident, Value::Sequence(values[range].to_vec()));
                Ok(())
            }
            pattern if is_rest(pattern) => Ok(()),
            pattern => self.bind(pattern, values[range.start].clone()),
        }
    }

    fn is_system(&self, path: &Path) -> bool {
        path.is_ident("Self") || path.is_ident(self.source.name())
    }

    fn bind_fields(&mut self, pattern: &PatStruct) -> Result<()> {
        for field in &pattern.fields {
            let member: &Member = &field.member;
            let word = Ident::new("self", span_of(member));
            self.bind(&field.pat, Value::Written(Written::leaf(quote!(#word.#member))))?;
        }
        Ok(())
    }

    /// The names that a pattern may bind.
    fn names(&self, pattern: &Pat) -> Vec<Ident> {
        let mut names = Names(Vec::new());
        names.visit_pat(pattern);
        names.0
    }
}

fn is_rest(pattern: &Pat) -> bool {
    matches!(pattern, Pat::Rest(_))
}

/// `..` or `rest @ ..`
fn is_rest_or_named(pattern: &Pat) -> bool {
    match pattern {
        Pat::Rest(_) => true,
        Pat::Ident(name) => name.subpat.as_ref().is_some_and(|(_, inner)| is_rest(inner)),
        _ => false,
    }
}

/// The entries that each pattern of a tuple or slice stands for; one for all but `..`.
fn parts<'p>(
    at: &Pat,
    patterns: impl ExactSizeIterator<Item = &'p Pat>,
    length: usize,
) -> Result<Vec<(&'p Pat, std::ops::Range<usize>)>> {
    let count = patterns.len();
    let patterns: Vec<&Pat> = patterns.collect();
    let rest = patterns.iter().position(|pattern| is_rest_or_named(pattern));
    let Some(skipped) = (match rest {
        Some(_) => (length + 1).checked_sub(count),
        None => (length == count).then_some(0),
    }) else {
        return refuse(at, "this pattern has another length than what it takes apart");
    };
    let mut start = 0;
    Ok(patterns
        .into_iter()
        .enumerate()
        .map(|(index, pattern)| {
            let end = start + if Some(index) == rest { skipped } else { 1 };
            let range = start..end;
            start = end;
            (pattern, range)
        })
        .filter(|(pattern, range)| !(range.is_empty() && is_rest(pattern)))
        .collect())
}

struct Names(Vec<Ident>);

impl<'ast> Visit<'ast> for Names {
    fn visit_pat_ident(&mut self, pattern: &'ast PatIdent) {
        if !self.0.contains(&pattern.ident) {
            self.0.push(pattern.ident.clone());
        }
        visit::visit_pat_ident(self, pattern);
    }
}
