//! Iterators, lazy as in Rust: closures run when an item is asked for.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

use super::super::number::Number;
use super::super::syntax::{Adaptor, Chain, Consumer, Kind, Operator, Source};
use super::{Exit, Interpreter, Result, Value};

/// An iterator.
pub enum Iteration<S> {
    Items(VecDeque<Value<S>>),
    Map(Box<Self>, Value<S>),
    Filter(Box<Self>, Value<S>),
    FlatMap(Box<Self>, Value<S>, VecDeque<Value<S>>),
    Zip(Box<Self>, Box<Self>),
    Linked(Box<Self>, Box<Self>),
    Enumerate(Box<Self>, i128),
    Reversed(Box<Self>),
    Skip(Box<Self>, usize),
    Take(Box<Self>, usize),
    /// With the step, and whether the first item is still to come.
    StepBy(Box<Self>, usize, bool),
    Shared(Rc<RefCell<Self>>),
}

impl<S: Number> Iteration<S> {
    pub fn next(&mut self, interpreter: &mut Interpreter<'_, S>) -> Result<S, Option<Value<S>>> {
        interpreter.fuel = interpreter.fuel.checked_sub(1).ok_or(Exit::Panic("too long"))?;
        match self {
            Self::Items(items) => Ok(items.pop_front()),
            Self::Map(inner, closure) => match inner.next(interpreter)? {
                Some(item) => interpreter.apply(closure, vec![item]).map(Some),
                None => Ok(None),
            },
            Self::Filter(inner, closure) => {
                while let Some(item) = inner.next(interpreter)? {
                    if interpreter.apply(closure, vec![item.clone()])?.truth() {
                        return Ok(Some(item));
                    }
                }
                Ok(None)
            }
            Self::FlatMap(inner, closure, front) => loop {
                if let Some(item) = front.pop_front() {
                    return Ok(Some(item));
                }
                match inner.next(interpreter)? {
                    Some(item) => *front = interpreter.apply(closure, vec![item])?.entries().into(),
                    None => return Ok(None),
                }
            },
            Self::Zip(a, b) => {
                let Some(a) = a.next(interpreter)? else { return Ok(None) };
                let Some(b) = b.next(interpreter)? else { return Ok(None) };
                Ok(Some(Value::Entries(vec![a, b])))
            }
            Self::Linked(a, b) => match a.next(interpreter)? {
                Some(item) => Ok(Some(item)),
                None => b.next(interpreter),
            },
            Self::Enumerate(inner, count) => Ok(inner.next(interpreter)?.map(|item| {
                *count += 1;
                Value::Entries(vec![Value::Integer(*count - 1), item])
            })),
            Self::Reversed(inner) => inner.next_back(interpreter),
            Self::Skip(inner, count) => {
                for _ in 0..std::mem::take(count) {
                    if inner.next(interpreter)?.is_none() {
                        return Ok(None);
                    }
                }
                inner.next(interpreter)
            }
            Self::Take(inner, count) => {
                if *count == 0 {
                    return Ok(None);
                }
                *count -= 1;
                inner.next(interpreter)
            }
            Self::StepBy(inner, step, is_first) => {
                if !std::mem::replace(is_first, false) {
                    for _ in 1..*step {
                        if inner.next(interpreter)?.is_none() {
                            return Ok(None);
                        }
                    }
                }
                inner.next(interpreter)
            }
            Self::Shared(shared) => shared.clone().borrow_mut().next(interpreter),
        }
    }

    fn next_back(&mut self, interpreter: &mut Interpreter<'_, S>) -> Result<S, Option<Value<S>>> {
        match self {
            Self::Items(items) => Ok(items.pop_back()),
            Self::Map(inner, closure) => match inner.next_back(interpreter)? {
                Some(item) => interpreter.apply(closure, vec![item]).map(Some),
                None => Ok(None),
            },
            Self::Filter(inner, closure) => {
                while let Some(item) = inner.next_back(interpreter)? {
                    if interpreter.apply(closure, vec![item.clone()])?.truth() {
                        return Ok(Some(item));
                    }
                }
                Ok(None)
            }
            Self::Zip(a, b) => {
                while a.length() > b.length() {
                    a.next_back(interpreter)?;
                }
                while b.length() > a.length() {
                    b.next_back(interpreter)?;
                }
                let Some(a) = a.next_back(interpreter)? else { return Ok(None) };
                let Some(b) = b.next_back(interpreter)? else { return Ok(None) };
                Ok(Some(Value::Entries(vec![a, b])))
            }
            Self::Linked(a, b) => match b.next_back(interpreter)? {
                Some(item) => Ok(Some(item)),
                None => a.next_back(interpreter),
            },
            Self::Enumerate(inner, count) => {
                let Some(item) = inner.next_back(interpreter)? else { return Ok(None) };
                let index = *count + inner.length() as i128;
                Ok(Some(Value::Entries(vec![Value::Integer(index), item])))
            }
            Self::Reversed(inner) => inner.next(interpreter),
            Self::Skip(inner, count) => {
                if inner.length() > *count {
                    inner.next_back(interpreter)
                } else {
                    Ok(None)
                }
            }
            Self::Take(inner, count) => {
                if *count == 0 {
                    return Ok(None);
                }
                for _ in 0..inner.length().saturating_sub(*count) {
                    inner.next_back(interpreter)?;
                }
                *count -= 1;
                inner.next_back(interpreter)
            }
            Self::StepBy(inner, step, is_first) => {
                let rest = inner.length() % *step;
                let beyond = match (*is_first, rest) {
                    (true, 0) => *step - 1,
                    (true, rest) => rest - 1,
                    (false, rest) => rest,
                };
                for _ in 0..beyond {
                    inner.next_back(interpreter)?;
                }
                inner.next_back(interpreter)
            }
            Self::FlatMap(..) | Self::Shared(_) => unreachable!("the generator does not reverse these"),
        }
    }

    /// How many items are left.
    fn length(&self) -> usize {
        match self {
            Self::Items(items) => items.len(),
            Self::Map(inner, _) | Self::Enumerate(inner, _) | Self::Reversed(inner) => inner.length(),
            Self::Zip(a, b) => a.length().min(b.length()),
            Self::Linked(a, b) => a.length() + b.length(),
            Self::Skip(inner, count) => inner.length().saturating_sub(*count),
            Self::Take(inner, count) => inner.length().min(*count),
            Self::StepBy(inner, step, true) => inner.length().div_ceil(*step),
            Self::StepBy(inner, step, false) => inner.length() / step,
            Self::Filter(..) | Self::FlatMap(..) | Self::Shared(_) => {
                unreachable!("the generator does not ask for the length of these")
            }
        }
    }
}

impl<S: Number> Interpreter<'_, S> {
    pub fn chain(&mut self, chain: &Chain) -> Result<S, Iteration<S>> {
        let items = |items: Vec<Value<S>>| Iteration::Items(items.into());
        let mut iteration = match &chain.source {
            Source::Iter(array) | Source::IntoIter(array) | Source::Plain(array) => {
                items(self.expression(array)?.entries())
            }
            Source::Range { start, end, closed } => {
                let (start, end) = (self.expression(start)?.integer(), self.expression(end)?.integer());
                if end - start > 1000 {
                    return Err(Exit::Panic("too long"));
                }
                let inner = (start..end).map(Value::Integer);
                items(inner.chain((*closed && start <= end).then_some(Value::Integer(end))).collect())
            }
            Source::Windows(array, width) => {
                let entries = self.expression(array)?.entries();
                items(entries.windows(*width).map(|window| Value::Entries(window.to_vec())).collect())
            }
            Source::Chunks(array, width, exact) => {
                let entries = self.expression(array)?.entries();
                let chunk = |chunk: &[Value<S>]| Value::Entries(chunk.to_vec());
                items(if *exact {
                    entries.chunks_exact(*width).map(chunk).collect()
                } else {
                    entries.chunks(*width).map(chunk).collect()
                })
            }
            Source::Local(name) | Source::ByReference(name) => match &*self.slot(name).borrow() {
                Value::Iterator(shared) => Iteration::Shared(shared.clone()),
                _ => unreachable!("programs are well typed"),
            },
        };
        for adaptor in &chain.adaptors {
            let inner = Box::new(iteration);
            iteration = match adaptor {
                Adaptor::Map(handed) => Iteration::Map(inner, self.handed(handed)),
                Adaptor::Filter(handed) => Iteration::Filter(inner, self.handed(handed)),
                Adaptor::FlatMap(handed) => Iteration::FlatMap(inner, self.handed(handed), VecDeque::new()),
                Adaptor::Zip(other, _) => Iteration::Zip(inner, Box::new(self.chain(other)?)),
                Adaptor::Linked(other) => Iteration::Linked(inner, Box::new(self.chain(other)?)),
                Adaptor::Enumerate => Iteration::Enumerate(inner, 0),
                Adaptor::Reversed => Iteration::Reversed(inner),
                Adaptor::Skip(count) => Iteration::Skip(inner, *count),
                Adaptor::Take(count) => Iteration::Take(inner, *count),
                Adaptor::StepBy(step) => Iteration::StepBy(inner, *step, true),
                Adaptor::Copied => *inner,
            };
        }
        Ok(iteration)
    }

    pub fn consume(&mut self, mut iteration: Iteration<S>, consumer: &Consumer) -> Result<S> {
        let option = |item: Option<Value<S>>| match item {
            Some(item) => Value::Variant(1, vec![item]),
            None => Value::Variant(0, Vec::new()),
        };
        match consumer {
            Consumer::Next => Ok(option(iteration.next(self)?)),
            Consumer::Count => {
                let mut count = 0;
                while iteration.next(self)?.is_some() {
                    count += 1;
                }
                Ok(Value::Integer(count))
            }
            Consumer::Fold(start, handed) => {
                let mut total = self.expression(start)?;
                let closure = self.handed(handed);
                while let Some(item) = iteration.next(self)? {
                    total = self.apply(&closure, vec![total, item])?;
                }
                Ok(total)
            }
            Consumer::Sum(kind, _) | Consumer::Product(kind, _) => {
                let is_sum = matches!(consumer, Consumer::Sum(..));
                let operator = if is_sum { Operator::Add } else { Operator::Multiply };
                let mut total = match kind {
                    // The standard library starts a sum of floats from −0.
                    Kind::Real => Value::Real(S::constant(if is_sum { -0.0 } else { 1.0 })),
                    _ => Value::Integer(i128::from(!is_sum)),
                };
                while let Some(item) = iteration.next(self)? {
                    total = self.operate(operator, *kind, total, item)?;
                }
                Ok(total)
            }
        }
    }
}
