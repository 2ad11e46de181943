//! One of two values by a condition, and values as the numbers and conditions that they are.

use std::rc::Rc;

use quote::ToTokens;

use super::super::graph::Node;
use super::value::{Chosen, Truth, Value};
use super::{Lowering, Result, refuse};

impl Lowering<'_> {
    /// The value as a number.
    pub fn scalar(&mut self, at: &impl ToTokens, value: Value) -> Result<Node> {
        match value {
            Value::Real(node) => Ok(node),
            Value::Written(written) => self.written_scalar(at, &written),
            Value::Chosen(chosen) => {
                let Chosen { condition, a, b, name } = &*chosen;
                let a = self.under(*condition, true, |this| this.scalar(at, a.clone()))?;
                let b = self.under(*condition, false, |this| this.scalar(at, b.clone()))?;
                let node = self.graph.select(*condition, a, b);
                if let Some(name) = name {
                    self.graph.give_name(node, name);
                }
                Ok(node)
            }
            Value::Integer(_) => refuse(at, "an integer stands where a floating-point number is needed"),
            Value::Unset => {
                refuse(at, "this local has no value on every way here; give it one where it is declared")
            }
            _ => refuse(at, "this is not a single number; take the entries of an array one by one"),
        }
    }

    /// The value as a condition.
    pub fn truth(&mut self, at: &impl ToTokens, value: Value) -> Result<Truth> {
        match value {
            Value::Truth(truth) => Ok(truth),
            Value::Written(written) => self.written_truth(at, &written).map(Truth::Where),
            Value::Chosen(chosen) => {
                let Chosen { condition, a, b, .. } = &*chosen;
                let a = self.under(*condition, true, |this| this.truth(at, a.clone()))?;
                let b = self.under(*condition, false, |this| this.truth(at, b.clone()))?;
                match self.select(at, *condition, Value::Truth(a), Value::Truth(b))? {
                    Value::Truth(truth) => Ok(truth),
                    _ => refuse(at, "this is not a condition that can be followed here"),
                }
            }
            _ => refuse(at, "this is not a condition that can be followed here"),
        }
    }

    /// Runs what is reached where the condition is `way`.
    pub fn under<T>(
        &mut self,
        condition: Node,
        way: bool,
        run: impl FnOnce(&mut Self) -> Result<T>,
    ) -> Result<T> {
        let outside = self.guards.len();
        self.guards.push((condition, way));
        let value = run(self);
        self.guards.truncate(outside);
        value
    }

    /// The condition under which the code being run is reached, if it is one.
    pub fn guard(&mut self) -> Option<Node> {
        let mut guard = Truth::Known(true);
        for (node, way) in self.guards.clone() {
            let condition = Truth::Where(node);
            let condition = if way { condition } else { condition.not(&mut self.graph) };
            guard = guard.and(&mut self.graph, condition);
        }
        match guard {
            Truth::Where(node) => Some(node),
            Truth::Known(_) => None,
        }
    }

    /// `a` where the condition holds, else `b`.
    pub fn select(&mut self, at: &impl ToTokens, condition: Node, a: Value, b: Value) -> Result<Value> {
        if a.same(&b) {
            return Ok(a);
        }
        self.unify_values(&a, &b)?;
        match (a, b) {
            (Value::Truth(a), Value::Truth(b)) => {
                let positive = a.and(&mut self.graph, Truth::Where(condition));
                let negated = Truth::Where(condition).not(&mut self.graph);
                let negative = b.and(&mut self.graph, negated);
                Ok(Value::Truth(positive.or(&mut self.graph, negative)))
            }
            (Value::Sequence(a), Value::Sequence(b)) if a.len() == b.len() => {
                self.select_all(at, condition, a, b).map(Value::Sequence)
            }
            (Value::Tuple(a), Value::Tuple(b)) if a.len() == b.len() => {
                self.select_all(at, condition, a, b).map(Value::Tuple)
            }
            (Value::Sequence(a), Value::Written(b)) => {
                let b = (0..a.len()).map(|index| Value::Written(b.entry(index))).collect();
                self.select_all(at, condition, a, b).map(Value::Sequence)
            }
            (Value::Written(a), Value::Sequence(b)) => {
                let a = (0..b.len()).map(|index| Value::Written(a.entry(index))).collect();
                self.select_all(at, condition, a, b).map(Value::Sequence)
            }
            (Value::Integer(a), Value::Integer(b)) if a.value == b.value => Ok(Value::Integer(a)),
            // Integers, or fields that may be.
            (
                a @ (Value::Integer(_) | Value::Written(_) | Value::Chosen(_)),
                b @ (Value::Integer(_) | Value::Written(_) | Value::Chosen(_)),
            ) => {
                let b = b.none_beside(&a);
                let a = a.none_beside(&b);
                Ok(Value::Chosen(Rc::new(Chosen { condition, a, b, name: None })))
            }
            (Value::Unset, _) | (_, Value::Unset) => Ok(Value::Unset),
            (a, b) => {
                let a = self.under(condition, true, |this| this.scalar(at, a))?;
                let b = self.under(condition, false, |this| this.scalar(at, b))?;
                Ok(Value::Real(self.graph.select(condition, a, b)))
            }
        }
    }

    /// Runs an operation on either of the two that a value may be, and selects between the results.
    pub fn distribute(
        &mut self,
        at: &impl ToTokens,
        chosen: &Chosen,
        mut run: impl FnMut(&mut Self, Value) -> Result<Value>,
    ) -> Result<Value> {
        self.count(at)?;
        let a = self.under(chosen.condition, true, |this| run(this, chosen.a.clone()))?;
        let b = self.under(chosen.condition, false, |this| run(this, chosen.b.clone()))?;
        self.select(at, chosen.condition, a, b)
    }

    pub fn select_all(
        &mut self,
        at: &impl ToTokens,
        condition: Node,
        a: Vec<Value>,
        b: Vec<Value>,
    ) -> Result<Vec<Value>> {
        a.into_iter().zip(b).map(|(a, b)| self.select(at, condition, a, b)).collect()
    }
}
