//! Places: locals, entries of their arrays, members of their tuples.

use syn::visit::{self, Visit};
use syn::{Expr, ExprArray, ExprTuple, Index, Member, UnOp};

use super::value::Value;
use super::{Lowering, Result, refuse};

/// A local, and the way from there.
pub struct Place {
    position: usize,
    steps: Vec<usize>,
}

impl Place {
    /// An entry of the array in the place.
    pub fn entry(&self, index: usize) -> Self {
        let steps = self.steps.iter().copied().chain([index]).collect();
        Self { position: self.position, steps }
    }
}

impl Lowering<'_> {
    /// `left = value`; a tuple or an array of places takes its parts from left to right.
    pub fn assign(&mut self, left: &Expr, value: Value) -> Result<Value> {
        match (left, value) {
            (Expr::Infer(_), _) => Ok(Value::unit()),
            (Expr::Tuple(ExprTuple { elems: places, .. }), Value::Tuple(values))
            | (Expr::Array(ExprArray { elems: places, .. }), Value::Sequence(values))
                if places.len() == values.len() =>
            {
                places
                    .iter()
                    .zip(values)
                    .try_for_each(|(place, value)| self.assign(place, value).map(drop))?;
                Ok(Value::unit())
            }
            (left, value) => {
                let place = self.place(left)?;
                self.write(left, &place, value)
            }
        }
    }

    /// The place, its indices computed once.
    pub fn place(&mut self, place: &Expr) -> Result<Place> {
        match place {
            Expr::Path(path) if path.path.get_ident().is_some_and(|name| name != "self") => {
                let name = path.path.segments[0].ident.to_string();
                match self.locals.iter().rposition(|(known, _)| *known == name) {
                    Some(position) => Ok(Place { position, steps: Vec::new() }),
                    None => refuse(place, "only locals can be assigned to"),
                }
            }
            Expr::Paren(inner) => self.place(&inner.expr),
            // The local stands for the entry that a loop lends.
            Expr::Unary(reference) if matches!(reference.op, UnOp::Deref(_)) => self.place(&reference.expr),
            Expr::Group(inner) => self.place(&inner.expr),
            Expr::Index(index) => {
                let mut place = self.place(&index.expr)?;
                match self.expression(&index.index)? {
                    Value::Integer(value) => place.steps.push(self.size(&index.index, value)?),
                    _ => return refuse(&index.index, "this index is not known at compile time"),
                }
                Ok(place)
            }
            Expr::Field(field) => {
                let mut place = self.place(&field.base)?;
                match &field.member {
                    Member::Unnamed(Index { index, .. }) => place.steps.push(*index as usize),
                    member => return refuse(member, "only locals can be assigned to"),
                }
                Ok(place)
            }
            other => refuse(other, "only locals and their entries can be assigned to"),
        }
    }

    /// The value in the place.
    pub fn read(&self, at: &Expr, place: &Place) -> Result<Value> {
        let mut value = &self.locals[place.position].1;
        for &step in &place.steps {
            value = match value {
                Value::Sequence(entries) | Value::Tuple(entries) if step < entries.len() => &entries[step],
                _ => return refuse(at, UNKNOWN_ENTRIES),
            };
        }
        Ok(value.clone())
    }

    /// `place = value`
    pub fn write(&mut self, at: &Expr, place: &Place, value: Value) -> Result<Value> {
        if place.position < self.captured {
            return refuse(
                at,
                "a closure or a block with a label cannot change a local of its surroundings here; use a `for` loop, or `fold`",
            );
        }
        let before = self.read(at, place)?;
        self.unify_values(&before, &value)?;
        let mut target = &mut self.locals[place.position].1;
        for &step in &place.steps {
            target = match target {
                Value::Sequence(entries) | Value::Tuple(entries) if step < entries.len() => {
                    &mut entries[step]
                }
                _ => return refuse(at, UNKNOWN_ENTRIES),
            };
        }
        *target = value;
        Ok(Value::unit())
    }
}

const UNKNOWN_ENTRIES: &str =
    "the entries of this place are not known here; give it a type, as in `let mut a: [f64; 3] = …`";

/// Whether running the expression may change a local.
pub fn may_assign(expression: &Expr) -> bool {
    let mut assignments = Assignments { found: false };
    assignments.visit_expr(expression);
    assignments.found
}

struct Assignments {
    found: bool,
}

impl<'ast> Visit<'ast> for Assignments {
    fn visit_expr(&mut self, expression: &'ast Expr) {
        self.found |= match expression {
            Expr::Assign(_) => true,
            Expr::Reference(reference) => reference.mutability.is_some(),
            Expr::MethodCall(call) => call.method == "swap" || call.method == "iter_mut",
            Expr::Binary(binary) => super::super::syntax::is_assignment(&binary.op),
            _ => false,
        };
        visit::visit_expr(self, expression);
    }
}
