//! Or-patterns: the first case that matches binds the names.

use quote::ToTokens;
use syn::visit::{self, Visit};
use syn::{Arm, Expr, Pat, PatOr};

use super::super::super::graph::Node;
use super::super::value::{Truth, Value};
use super::super::{Lowering, Result, refuse};
use super::matching::Test;

impl Lowering<'_> {
    /// Whether one of the cases matches; where numbers decide which, every name is a selection.
    pub fn test_cases(&mut self, at: &Pat, cases: &[&Pat], value: &Value) -> Result<Test> {
        let Some((case, others)) = cases.split_first() else {
            return Ok((Truth::Known(false), Vec::new()));
        };
        let (truth, bound) = self.test(case, value)?;
        let condition = match truth {
            Truth::Known(true) => return Ok((truth, bound)),
            Truth::Known(false) => return self.test_cases(at, others, value),
            Truth::Where(condition) => condition,
        };
        let (otherwise, bound_otherwise) = self.test_cases(at, others, value)?;
        let bound = match otherwise {
            Truth::Known(false) => bound,
            _ => self.either(at, condition, bound, bound_otherwise)?,
        };
        Ok((truth.or(&mut self.graph, otherwise), bound))
    }

    /// Names that a pattern binds, `a` where the condition holds; one that one way alone binds is asked for
    /// there alone.
    pub fn either(
        &mut self,
        at: &Pat,
        condition: Node,
        a: Vec<(String, Value)>,
        mut b: Vec<(String, Value)>,
    ) -> Result<Vec<(String, Value)>> {
        let mut bound = Vec::new();
        for (name, value) in a {
            let other = b.iter().position(|(known, _)| *known == name).map(|index| b.swap_remove(index));
            let value = match other {
                Some((_, other)) => self.select(at, condition, value, other)?,
                None => value,
            };
            bound.push((name, value));
        }
        bound.extend(b);
        Ok(bound)
    }

    /// The arms; Rust asks a guard for each case of its pattern that matches, so that cases that bind names
    /// and may overlap are arms of their own.
    pub fn arms<'a>(&self, arms: &'a [Arm]) -> Vec<Case<'a>> {
        let mut all = Vec::new();
        for arm in arms {
            let (pattern, guard) = match &arm.pat {
                Pat::Guard(guarded) => (&*guarded.pat, Some(&*guarded.guard)),
                pattern => (pattern, None),
            };
            match pattern {
                Pat::Or(or)
                    if guard.is_some()
                        && !is_exclusive(or.cases.iter())
                        && !self.names(pattern).is_empty() =>
                {
                    all.extend(or.cases.iter().map(|pattern| Case { pattern, guard, body: &arm.body }));
                }
                _ => all.push(Case { pattern, guard, body: &arm.body }),
            }
        }
        all
    }

    /// Refuses cases that bind names and may overlap: a guard is asked for each that matches.
    pub fn without_overlap(&self, pattern: &Pat) -> Result<()> {
        struct Overlap(Option<Pat>);
        impl<'ast> Visit<'ast> for Overlap {
            fn visit_pat_or(&mut self, or: &'ast PatOr) {
                if !is_exclusive(or.cases.iter()) {
                    self.0 = Some(Pat::Or(or.clone()));
                }
                visit::visit_pat_or(self, or);
            }
        }
        let mut overlap = Overlap(None);
        overlap.visit_pat(pattern);
        match overlap.0 {
            Some(or) if !self.names(&or).is_empty() => {
                refuse(&or, "the guard is asked for each of these cases that matches; write an arm for each")
            }
            _ => Ok(()),
        }
    }
}

/// An arm of a `match`, as far as one case of it.
#[derive(Clone, Copy)]
pub struct Case<'a> {
    pub pattern: &'a Pat,
    pub guard: Option<&'a Expr>,
    pub body: &'a Expr,
}

/// Whether no two of the cases can match one value: they are variants of different names.
pub fn is_exclusive<'p>(cases: impl Iterator<Item = &'p Pat>) -> bool {
    let mut names = Vec::new();
    for case in cases {
        let path = match case {
            Pat::TupleStruct(case) => &case.path,
            Pat::Struct(case) => &case.path,
            Pat::Path(case) => &case.path,
            _ => return false,
        };
        let name = path.segments.last().map(|segment| segment.ident.to_token_stream().to_string());
        if names.contains(&name) {
            return false;
        }
        names.push(name);
    }
    true
}
