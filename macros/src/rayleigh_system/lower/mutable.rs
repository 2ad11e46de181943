//! Entries of arrays that a loop changes, as in `for (i, x) in a.iter_mut().enumerate()`, and entries that
//! change places.

use syn::{Expr, ExprCall, ExprForLoop, ExprMethodCall, Ident, Pat};

use super::super::syntax::{is_self, without_parentheses};
use super::class::IntegerType;
use super::place::Place;
use super::value::Value;
use super::{Lowering, Result, refuse};

/// A loop over the places of an array.
pub struct Mutable<'e> {
    array: &'e Expr,
    /// Partners of the entries, innermost first.
    pairs: Vec<Pair<'e>>,
    /// The local that stands for the entry.
    entry: &'e Ident,
}

enum Pair<'e> {
    /// `(i, x)`
    Number(&'e Pat),
    /// `(x, y)` for the entries of another array.
    Other(&'e Expr, &'e Pat),
}

impl<'e> Mutable<'e> {
    /// The loop, if it is one whose entries can be changed.
    pub fn of(iterated: &'e Expr, pattern: &'e Pat) -> Option<Self> {
        match without_parentheses(iterated) {
            Expr::Reference(reference) if reference.mutability.is_some() => {
                Some(Self { array: &reference.expr, pairs: Vec::new(), entry: name(pattern)? })
            }
            Expr::MethodCall(call) if call.method == "iter_mut" && call.args.is_empty() => {
                Some(Self { array: &call.receiver, pairs: Vec::new(), entry: name(pattern)? })
            }
            Expr::MethodCall(call) => {
                let Pat::Tuple(tuple) = pattern else { return None };
                let [first, second] = tuple.elems.iter().collect::<Vec<_>>()[..] else { return None };
                let (inner, pair) = match (call.method.to_string().as_str(), call.args.first()) {
                    ("enumerate", None) => (second, Pair::Number(first)),
                    ("zip", Some(other)) => (first, Pair::Other(other, second)),
                    _ => return None,
                };
                let mut of = Self::of(&call.receiver, inner)?;
                of.pairs.push(pair);
                Some(of)
            }
            _ => None,
        }
    }
}

fn name(pattern: &Pat) -> Option<&Ident> {
    match pattern {
        Pat::Ident(name) if name.subpat.is_none() && name.by_ref.is_none() => Some(&name.ident),
        _ => None,
    }
}

impl Lowering<'_> {
    /// The loop: each turn has the entry in a local, and puts back what has become of it. Nothing else can
    /// read the array meanwhile.
    pub fn for_each_place(&mut self, each: &ExprForLoop, mutable: &Mutable<'_>) -> Result<Value> {
        let array = self.place(mutable.array)?;
        let Value::Sequence(entries) = self.read(mutable.array, &array)? else {
            return refuse(mutable.array, "the length of this array is not known here; give it a type");
        };
        let mut count = entries.len();
        let mut others = Vec::new();
        for pair in &mutable.pairs {
            let Pair::Other(other, _) = pair else { continue };
            let Value::Sequence(values) = self.expression(other)? else {
                return refuse(other, "the length of what is zipped with is not known here");
            };
            count = count.min(values.len());
            others.push(values);
        }
        self.integers.has_dead_code |= count == 0;
        for (index, entry) in entries.into_iter().enumerate().take(count) {
            self.count(&each.pat)?;
            let outside = self.locals.len();
            let mut others = others.iter();
            for pair in &mutable.pairs {
                match pair {
                    Pair::Number(pattern) => {
                        let number = self.integer(pattern, index as i128, Some(IntegerType::USIZE))?;
                        self.bind(pattern, number)?;
                    }
                    Pair::Other(other, pattern) => match others.next() {
                        Some(values) => self.bind(pattern, values[index].clone())?,
                        None => return refuse(other, "this cannot be followed here"),
                    },
                }
            }
            let position = self.locals.len();
            self.locals.push((mutable.entry.to_string(), entry));
            self.block(&each.body)?;
            let changed = self.locals[position].1.clone();
            self.locals.truncate(outside);
            self.write(mutable.array, &array.entry(index), changed)?;
            if self.ends(each.label.as_ref()).is_some() {
                break;
            }
        }
        Ok(Value::unit())
    }

    /// `a.swap(i, j)`; nothing if it is another method.
    pub fn swap_entries(&mut self, call: &ExprMethodCall) -> Result<Option<Value>> {
        let [i, j] = call.args.iter().collect::<Vec<_>>()[..] else { return Ok(None) };
        if call.method != "swap" || is_self(&call.receiver) {
            return Ok(None);
        }
        let array = self.place(&call.receiver)?;
        let mut places = Vec::new();
        for index in [i, j] {
            match self.expression(index)? {
                Value::Integer(value) => places.push(array.entry(self.size(index, value)?)),
                _ => return refuse(index, "this index is not known at compile time"),
            }
        }
        self.swap(&call.receiver, &places[0], &call.receiver, &places[1]).map(Some)
    }

    /// `std::mem::swap(&mut a, &mut b)`
    pub fn swap_places(&mut self, call: &ExprCall) -> Result<Value> {
        let mut places = Vec::new();
        for argument in &call.args {
            match without_parentheses(argument) {
                Expr::Reference(reference) if reference.mutability.is_some() => {
                    places.push((&*reference.expr, self.place(&reference.expr)?));
                }
                other => return refuse(other, "only locals and their entries can be swapped here"),
            }
        }
        match &places[..] {
            [(a, first), (b, second)] => self.swap(a, first, b, second),
            _ => refuse(call, "called with another number of arguments than it has parameters"),
        }
    }

    fn swap(&mut self, a: &Expr, first: &Place, b: &Expr, second: &Place) -> Result<Value> {
        let (of_first, of_second) = (self.read(a, first)?, self.read(b, second)?);
        self.write(a, first, of_second)?;
        self.write(b, second, of_first)
    }
}
