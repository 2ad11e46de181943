//! Whether values match patterns.

use std::rc::Rc;

use proc_macro2::TokenStream;
use quote::{ToTokens, quote};
use syn::visit::{self, Visit};
use syn::visit_mut::{self, VisitMut};
use syn::{Expr, ExprPath, Ident, Lit, Pat, PatIdent, Path, RangeLimits};

use super::super::class::{Integer, IntegerType};
use super::super::operator::literal;
use super::super::value::{Truth, Value};
use super::super::written::{Arm, Leaf, Text, Written};
use super::super::{Lowering, Refusal, Result, refuse};
use super::{is_rest_or_named, parts};

/// The condition under which a pattern matches, and the names that it binds.
pub type Test = (Truth, Vec<(String, Value)>);

impl Lowering<'_> {
    /// Whether the value matches, and what the pattern binds where it does.
    pub fn test(&mut self, pattern: &Pat, value: &Value) -> Result<Test> {
        let yes = |bound| Ok((Truth::Known(true), bound));
        match (pattern, value) {
            (Pat::Wild(_) | Pat::Rest(_), _) => yes(Vec::new()),
            (Pat::Paren(inner), value) => self.test(&inner.pat, value),
            (pattern, Value::Written(written)) if !self.matches_always(pattern) => {
                self.test_written(pattern, written)
            }
            (pattern, value) if self.matches_always(pattern) => {
                let outside = self.locals.len();
                let names = self.names(pattern);
                self.bind(pattern, value.clone())?;
                let bound = self.locals.split_off(outside);
                if let Value::Written(written) = value {
                    // What a constant matches is the constant: the value is the same either way.
                    let truth = if names.is_empty() {
                        Truth::Known(true)
                    } else {
                        self.test_written(pattern, written)?.0
                    };
                    return Ok((truth, bound));
                }
                self.bindings.extend(names.into_iter().map(|name| (name.to_string(), name)));
                yes(bound)
            }
            (Pat::Ident(PatIdent { ident, subpat: Some((_, inner)), .. }), value) => {
                let (truth, mut bound) = self.test(inner, value)?;
                bound.insert(0, (ident.to_string(), value.clone()));
                self.bindings.insert(ident.to_string(), ident.clone());
                Ok((truth, bound))
            }
            (Pat::Reference(inner), value) => self.test(&inner.pat, value),
            (Pat::Or(or), value) => {
                let cases: Vec<&Pat> = or.cases.iter().collect();
                self.test_cases(pattern, &cases, value)
            }
            (Pat::Lit(literal), value) => self.test_literal(pattern, &literal.lit, value),
            (Pat::Path(path), Value::Integer(value)) => self.test_constant(pattern, path, *value),
            (Pat::Ident(name), Value::Integer(value)) => {
                let path = ExprPath { attrs: Vec::new(), qself: None, path: name.ident.clone().into() };
                self.test_constant(pattern, &path, *value)
            }
            (Pat::Range(range), Value::Integer(value)) => {
                let mut known = |bound: &Expr| match self.expression(bound)? {
                    Value::Integer(bound) => {
                        self.integers.unify(bound.class, value.class)?;
                        Ok(bound.value)
                    }
                    _ => refuse(bound, "only integers known at compile time can bound a pattern here"),
                };
                let above = range
                    .start
                    .as_deref()
                    .map(&mut known)
                    .transpose()?
                    .is_none_or(|start| value.value >= start);
                let end = range.end.as_deref().map(&mut known).transpose()?;
                let is_closed = matches!(range.limits, RangeLimits::Closed(_));
                let below =
                    end.is_none_or(|end| if is_closed { value.value <= end } else { value.value < end });
                Ok((Truth::Known(above && below), Vec::new()))
            }
            (Pat::Tuple(tuple), Value::Tuple(values)) => {
                let parts = parts(pattern, tuple.elems.iter(), values.len())?;
                self.test_parts(
                    parts.into_iter().map(|(pattern, range)| (pattern, values[range.start].clone())),
                )
            }
            (Pat::Slice(slice), Value::Sequence(values)) => {
                self.test_slice(pattern, slice.elems.iter(), values)
            }
            (pattern, Value::Chosen(chosen)) => {
                let (a, bound_a) = self.test(pattern, &chosen.a)?;
                let (b, bound_b) = self.test(pattern, &chosen.b)?;
                let bound = self.either(pattern, chosen.condition, bound_a, bound_b)?;
                match self.select(pattern, chosen.condition, Value::Truth(a), Value::Truth(b))? {
                    Value::Truth(truth) => Ok((truth, bound)),
                    _ => refuse(pattern, "this pattern cannot be followed here"),
                }
            }
            (Pat::Ident(_) | Pat::Path(_), Value::Real(_)) => {
                let reason = "a number cannot be matched with a constant; compare it with `if`";
                Err(Refusal::at(pattern, reason).for_all())
            }
            (Pat::Ident(_) | Pat::Path(_), _) => {
                refuse(pattern, "a number is matched with what may be a constant; compare it with `if`")
            }
            _ => refuse(
                pattern,
                "only fields, integers and bools can be matched here; compare numbers with `if`",
            ),
        }
    }

    /// Lets rustc match a field or constant.
    pub fn test_written(&mut self, pattern: &Pat, written: &Written) -> Result<Test> {
        if let Some(hidden) = hidden(pattern) {
            return refuse(&hidden, "macros and blocks in patterns cannot be followed here");
        }
        let Text { tokens, arms, may_panic } = self.text(pattern, written)?;
        let mut outside = pattern.clone();
        Imports { lowering: self }.visit_pat_mut(&mut outside);
        // No macro takes a pattern that begins with `..=`.
        if outside.to_token_stream().to_string().starts_with("..") {
            outside = syn::parse_quote!((#outside));
        }
        let truth =
            Text { tokens: quote!(::core::matches!(#tokens, #outside)), arms: arms.clone(), may_panic };
        let truth = self.text_truth(truth);
        if let Some(name) = variant(pattern) {
            self.graph.give_name(truth, &name);
        }
        let names = self.names(pattern);
        let arm = Rc::new(Arm {
            scrutinee: tokens,
            pattern: outside.to_token_stream(),
            names: names.iter().map(Ident::to_string).collect(),
        });
        let arms: Vec<Rc<Arm>> = arms.into_iter().chain([arm]).collect();
        let bound = names.into_iter().map(|name| {
            let leaf = Leaf { tokens: name.to_token_stream(), arms: arms.clone(), may_panic, is_bound: true };
            let plain = name.to_string().trim_start_matches("r#").to_owned();
            (name.to_string(), Value::Written(Written::Named(plain, Box::new(Written::Leaf(leaf)))))
        });
        Ok((Truth::Where(truth), bound.collect()))
    }

    fn test_literal(&mut self, at: &Pat, pattern: &Lit, value: &Value) -> Result<Test> {
        let truth = match (pattern, value) {
            (Lit::Int(literal), Value::Integer(value)) => {
                if let Some(ty) = IntegerType::named(literal.suffix()) {
                    self.of_type(value.class, ty)?;
                }
                let Ok(number) = literal.base10_parse::<i128>() else {
                    return refuse(literal, "not an integer that can be read");
                };
                Truth::Known(number == value.value)
            }
            (Lit::Bool(literal), Value::Truth(truth)) => {
                if literal.value {
                    *truth
                } else {
                    truth.not(&mut self.graph)
                }
            }
            _ => return refuse(at, "only integers and bools can be matched here; compare numbers with `if`"),
        };
        Ok((truth, Vec::new()))
    }

    /// An integer against a constant, or against what rustc knows to be one or a binding.
    fn test_constant(&mut self, at: &Pat, path: &ExprPath, value: Integer) -> Result<Test> {
        let truth = match self.expression(&Expr::Path(path.clone()))? {
            Value::Integer(constant) => {
                self.integers.unify(constant.class, value.class)?;
                Truth::Known(constant.value == value.value)
            }
            Value::Written(_) => {
                self.beside_field(value);
                let (truth, names) = self.test_written(at, &literal(value))?;
                // A constant or a binding, as rustc knows: where the pattern matches, it is this integer.
                return Ok((
                    truth,
                    names.into_iter().map(|(name, _)| (name, Value::Integer(value))).collect(),
                ));
            }
            _ => return refuse(at, "only integers and bools can be matched here"),
        };
        Ok((truth, Vec::new()))
    }

    /// All parts must match.
    fn test_parts<'p>(&mut self, parts: impl Iterator<Item = (&'p Pat, Value)>) -> Result<Test> {
        let (mut all, mut bound) = (Truth::Known(true), Vec::new());
        for (pattern, value) in parts {
            let (truth, names) = self.test(pattern, &value)?;
            all = all.and(&mut self.graph, truth);
            bound.extend(names);
        }
        Ok((all, bound))
    }

    fn test_slice<'p>(
        &mut self,
        at: &Pat,
        patterns: impl ExactSizeIterator<Item = &'p Pat>,
        values: &[Value],
    ) -> Result<Test> {
        let patterns: Vec<&Pat> = patterns.collect();
        let has_rest = patterns.iter().any(|pattern| is_rest_or_named(pattern));
        let least = patterns.len() - usize::from(has_rest);
        if values.len() < least || (!has_rest && values.len() > least) {
            return Ok((Truth::Known(false), Vec::new()));
        }
        let (mut all, mut bound) = (Truth::Known(true), Vec::new());
        for (pattern, range) in parts(at, patterns.into_iter(), values.len())? {
            if is_rest_or_named(pattern) {
                let outside = self.locals.len();
                self.bind_part(pattern, values, range)?;
                bound.extend(self.locals.split_off(outside));
                continue;
            }
            let (truth, names) = self.test(pattern, &values[range.start])?;
            all = all.and(&mut self.graph, truth);
            bound.extend(names);
        }
        Ok((all, bound))
    }

    /// Whether a pattern of names, tuples and `_` matches whatever its value; names in small letters, unless
    /// the body imports them, are taken for bindings, and rustc is asked to agree.
    fn matches_always(&self, pattern: &Pat) -> bool {
        match pattern {
            Pat::Wild(_) => true,
            Pat::Ident(name) => {
                let is_small = name.ident.to_string().starts_with(|c: char| c.is_lowercase() || c == '_');
                let is_imported = matches!(self.local(&name.ident), Some(Value::Import(_)));
                is_small
                    && !is_imported
                    && name.subpat.as_ref().is_none_or(|(_, inner)| self.matches_always(inner))
            }
            Pat::Paren(inner) => self.matches_always(&inner.pat),
            Pat::Type(inner) => self.matches_always(&inner.pat),
            Pat::Reference(inner) => self.matches_always(&inner.pat),
            Pat::Tuple(tuple) => tuple.elems.iter().all(|pattern| self.matches_always(pattern)),
            _ => false,
        }
    }
}

/// `Friction::Linear(_)` → `is_linear`.
fn variant(pattern: &Pat) -> Option<String> {
    let path = match pattern {
        Pat::Path(path) => &path.path,
        Pat::TupleStruct(pattern) => &pattern.path,
        Pat::Struct(pattern) => &pattern.path,
        Pat::Ident(name) => return Some(format!("is_{}", name.ident.to_string().to_lowercase())),
        Pat::Paren(inner) => return variant(&inner.pat),
        Pat::Reference(inner) => return variant(&inner.pat),
        _ => return None,
    };
    path.segments.last().map(|segment| format!("is_{}", segment.ident.to_string().to_lowercase()))
}

/// The part of a pattern that the macro cannot see into, if there is one.
fn hidden(pattern: &Pat) -> Option<TokenStream> {
    struct Hidden(Option<TokenStream>);
    impl<'ast> Visit<'ast> for Hidden {
        fn visit_pat(&mut self, pattern: &'ast Pat) {
            if let Pat::Macro(_) | Pat::Const(_) | Pat::Verbatim(_) | Pat::Guard(_) = pattern {
                self.0 = Some(pattern.to_token_stream());
            }
            visit::visit_pat(self, pattern);
        }
    }
    let mut hidden = Hidden(None);
    hidden.visit_pat(pattern);
    hidden.0
}

/// Paths as they read outside the body.
struct Imports<'l, 's> {
    lowering: &'l Lowering<'s>,
}

impl VisitMut for Imports<'_, '_> {
    fn visit_pat_mut(&mut self, pattern: &mut Pat) {
        if let Pat::Ident(PatIdent { ident, subpat: None, .. }) = pattern
            && let Some(Value::Import(path)) = self.lowering.local(ident)
            && let Ok(path) = syn::parse2(path.clone())
        {
            *pattern = Pat::Path(ExprPath { attrs: Vec::new(), qself: None, path });
            return;
        }
        visit_mut::visit_pat_mut(self, pattern);
    }

    fn visit_path_mut(&mut self, path: &mut Path) {
        if path.leading_colon.is_none()
            && let Some(Value::Import(import)) = self.lowering.local(&path.segments[0].ident)
            && let Ok(mut whole) = syn::parse2::<Path>(import.clone())
        {
            whole.segments.extend(path.segments.iter().skip(1).cloned());
            if let Some(last) = path.segments.last()
                && path.segments.len() == 1
                && let Some(segment) = whole.segments.last_mut()
            {
                segment.arguments = last.arguments.clone();
            }
            *path = whole;
        }
    }
}
