//! `if`, `match`, `let … else` and `matches!`: what numbers decide runs every way, and every local that
//! differs becomes a selection.

use syn::{Expr, ExprIf, ExprLet, ExprMatch, Macro, Pat};

use quote::ToTokens;

use super::super::graph::Operation;
use super::super::syntax::Matches;
use super::pattern::cases::Case;
use super::value::{Truth, Value};
use super::{Lowering, Node, Result, Returned, refuse};

impl Lowering<'_> {
    /// Runs `a` where the condition holds and `b` where it does not; the value is selected.
    pub fn branch(
        &mut self,
        at: &impl ToTokens,
        condition: Node,
        a: impl FnOnce(&mut Self) -> Result<Value>,
        b: impl FnOnce(&mut Self) -> Result<Value>,
    ) -> Result<Value> {
        let (a, b, [a_returned, b_returned]) = self.ways(at, condition, a, b)?;
        match (a_returned, b_returned) {
            (true, _) => Ok(b),
            (_, true) => Ok(a),
            _ => self.select(at, condition, a, b),
        }
    }

    /// The values of both ways.
    pub fn branch_values(
        &mut self,
        at: &impl ToTokens,
        condition: Node,
        a: impl FnOnce(&mut Self) -> Result<Value>,
        b: impl FnOnce(&mut Self) -> Result<Value>,
    ) -> Result<(Value, Value)> {
        let (a, b, _) = self.ways(at, condition, a, b)?;
        Ok((a, b))
    }

    /// Both ways start from the same locals; where they end differently, the condition selects. Last, whether
    /// either way has surely returned.
    fn ways(
        &mut self,
        at: &impl ToTokens,
        condition: Node,
        a: impl FnOnce(&mut Self) -> Result<Value>,
        b: impl FnOnce(&mut Self) -> Result<Value>,
    ) -> Result<(Value, Value, [bool; 2])> {
        let before = self.locals.clone();
        let returned_before = self.returned.clone();
        let a = self.under(condition, true, a)?;
        let locals_a = std::mem::replace(&mut self.locals, before);
        let returned_a = std::mem::replace(&mut self.returned, returned_before.clone());
        let leaving_a = self.leaving.take();
        let b = self.under(condition, false, b)?;
        if leaving_a.or(self.leaving.take()).is_some() {
            return refuse(
                at,
                "a loop that numbers decide to leave cannot be written out; select a value with `if` instead",
            );
        }
        let always = [&returned_a, &self.returned].map(|returned| matches!(returned, Returned::Always(_)));
        let locals_b = std::mem::take(&mut self.locals);
        match always {
            [true, _] => self.locals = locals_b,
            [_, true] => self.locals = locals_a,
            _ => {
                for ((name, a), (_, b)) in locals_a.into_iter().zip(locals_b) {
                    let value = self.select(at, condition, a, b)?;
                    self.locals.push((name, value));
                }
            }
        }
        let returned_b = std::mem::replace(&mut self.returned, Returned::Never);
        self.returned = self.joined(at, condition, &returned_before, returned_a, returned_b)?;
        // What follows is reached where nothing has been returned.
        if let Returned::Where(returned, _) = self.returned {
            self.guards.push((returned, false));
        }
        Ok((a, b, always))
    }

    /// Joins what the two ways of a condition have returned, which may be no more than was `before`.
    fn joined(
        &mut self,
        at: &impl ToTokens,
        condition: Node,
        before: &Returned,
        a: Returned,
        b: Returned,
    ) -> Result<Returned> {
        let is_before = |value: &Value| matches!(before, Returned::Where(_, before) if value.same(before));
        let parts = |returned| match returned {
            Returned::Never => (Truth::Known(false), None),
            Returned::Where(node, value) => (Truth::Where(node), Some(value)),
            Returned::Always(value) => (Truth::Known(true), Some(value)),
        };
        let ((where_a, a), (where_b, b)) = (parts(a), parts(b));
        let value = match (a, b) {
            (None, None) => return Ok(Returned::Never),
            // A way that returns where nothing was has what was before beside it: once, not once a return.
            (Some(a), Some(b)) if is_before(&b) => a,
            (Some(a), Some(b)) if is_before(&a) => b,
            (Some(a), Some(b)) => self.select(at, condition, a, b)?,
            (Some(value), None) | (None, Some(value)) => value,
        };
        let graph = &mut self.graph;
        let place = if where_a == where_b {
            where_a
        } else {
            let negated = graph.node(Operation::Not(condition));
            let (a, b) =
                (Truth::Where(condition).and(graph, where_a), Truth::Where(negated).and(graph, where_b));
            a.or(graph, b)
        };
        Ok(match place {
            Truth::Known(true) => Returned::Always(value),
            Truth::Known(false) => Returned::Never,
            Truth::Where(node) => Returned::Where(node, value),
        })
    }

    pub fn choice(&mut self, choice: &ExprIf) -> Result<Value> {
        let outside = self.locals.len();
        let condition = self.condition(&choice.cond)?;
        // What `if let` binds is seen by the first branch alone.
        let bound = self.locals.split_off(outside);
        let first = |this: &mut Self| {
            this.locals.extend(bound);
            let value = this.block(&choice.then_branch);
            this.locals.truncate(outside);
            value
        };
        let otherwise = |this: &mut Self| match &choice.else_branch {
            Some((_, otherwise)) => this.expression(otherwise),
            None => Ok(Value::unit()),
        };
        match condition {
            Truth::Where(condition) => self.branch(&choice.cond, condition, first, otherwise),
            Truth::Known(holds) => {
                self.integers.has_dead_code |= !holds || choice.else_branch.is_some();
                if holds { first(self) } else { otherwise(self) }
            }
        }
    }

    /// A condition, `let` among it; what that binds is left among the locals.
    pub fn condition(&mut self, condition: &Expr) -> Result<Truth> {
        match condition {
            Expr::Let(ExprLet { pat, expr, .. }) => {
                let value = self.expression(expr)?;
                let (truth, bound) = self.test(pat, &value)?;
                self.locals.extend(bound);
                Ok(truth)
            }
            Expr::Binary(binary) if matches!(binary.op, syn::BinOp::And(_)) && holds_let(condition) => {
                let left = self.condition(&binary.left)?;
                match left {
                    Truth::Known(false) => Ok(left),
                    Truth::Known(true) => self.condition(&binary.right),
                    Truth::Where(node) => {
                        let right =
                            self.under(node, true, |this| this.unchanging(&binary.right, Self::condition))?;
                        Ok(left.and(&mut self.graph, right))
                    }
                }
            }
            other => {
                let value = self.expression(other)?;
                self.truth(other, value)
            }
        }
    }

    /// Runs what numbers decide to run, and what therefore must not change a local.
    fn unchanging<T>(
        &mut self,
        condition: &Expr,
        run: impl FnOnce(&mut Self, &Expr) -> Result<T>,
    ) -> Result<T> {
        if super::place::may_assign(condition) {
            return refuse(
                condition,
                "whether this runs depends on numbers, and it changes a local; use `if`",
            );
        }
        run(self, condition)
    }

    pub fn match_arms(&mut self, choice: &ExprMatch) -> Result<Value> {
        let value = self.expression(&choice.expr)?;
        let arms = self.arms(&choice.arms);
        self.arms_from(&choice.expr, &arms, &value)
    }

    /// The arms, from the first of these on: the first that matches.
    fn arms_from(&mut self, at: &Expr, arms: &[Case<'_>], value: &Value) -> Result<Value> {
        let Some((&Case { pattern, guard, body }, others)) = arms.split_first() else {
            return refuse(at, "no arm matches");
        };
        if guard.is_some() {
            self.without_overlap(pattern)?;
        }
        let outside = self.locals.len();
        let (mut truth, bound) = self.test(pattern, value)?;
        // Arms are exhaustive: rustc checks it.
        if others.is_empty() && guard.is_none() && truth != Truth::Known(false) {
            truth = Truth::Known(true);
        }
        if truth == Truth::Known(false) {
            self.integers.has_dead_code = true;
            return self.arms_from(at, others, value);
        }
        if let Some(guard) = guard {
            self.locals.extend(bound.iter().cloned());
            let holds = match truth {
                Truth::Where(node) => {
                    self.under(node, true, |this| this.unchanging(guard, Self::condition))?
                }
                Truth::Known(_) => self.unchanging(guard, Self::condition)?,
            };
            self.locals.truncate(outside);
            truth = truth.and(&mut self.graph, holds);
        }
        let run = |this: &mut Self| {
            this.locals.extend(bound);
            let value = this.expression(body);
            this.locals.truncate(outside);
            value
        };
        match truth {
            Truth::Known(true) => {
                self.integers.has_dead_code |= !others.is_empty();
                run(self)
            }
            Truth::Known(false) => self.arms_from(at, others, value),
            Truth::Where(condition) => {
                self.branch(pattern, condition, run, |this| this.arms_from(at, others, value))
            }
        }
    }

    /// `let pattern = value else { … };`
    pub fn let_else(&mut self, pattern: &Pat, value: &Value, otherwise: &Expr) -> Result<()> {
        let (truth, bound) = self.test(pattern, value)?;
        match truth {
            Truth::Known(true) => self.integers.has_dead_code = true,
            Truth::Known(false) => {
                self.expression(otherwise)?;
            }
            Truth::Where(condition) => {
                self.branch(pattern, condition, |_| Ok(Value::unit()), |this| this.expression(otherwise))?;
            }
        }
        self.locals.extend(bound);
        Ok(())
    }

    /// `matches!(value, pattern if guard)`
    pub fn matches_macro(&mut self, invocation: &Macro) -> Result<Value> {
        if !invocation.path.is_ident("matches") {
            return refuse(invocation, "macros hide what they compute; write the expression out");
        }
        let Ok(Matches { value, pattern, guard }) = invocation.parse_body() else {
            return refuse(invocation, "not `matches!(value, pattern)`");
        };
        let value = self.expression(&value)?;
        let outside = self.locals.len();
        if guard.is_some() {
            self.without_overlap(&pattern)?;
        }
        let (truth, bound) = self.test(&pattern, &value)?;
        self.locals.extend(bound);
        let truth = match (guard, truth) {
            (None, truth) => truth,
            (Some(_), Truth::Known(false)) => truth,
            (Some(guard), Truth::Known(true)) => self.unchanging(&guard, Self::condition)?,
            (Some(guard), Truth::Where(node)) => {
                let holds = self.under(node, true, |this| this.unchanging(&guard, Self::condition))?;
                truth.and(&mut self.graph, holds)
            }
        };
        self.locals.truncate(outside);
        Ok(Value::Truth(truth))
    }
}

/// Whether the condition is a chain with `let` in it.
fn holds_let(condition: &Expr) -> bool {
    match condition {
        Expr::Let(_) => true,
        Expr::Binary(binary) if matches!(binary.op, syn::BinOp::And(_)) => {
            holds_let(&binary.left) || holds_let(&binary.right)
        }
        _ => false,
    }
}
