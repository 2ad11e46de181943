//! Blocks, `if`, loops and departures from them.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Block, Expr, ExprForLoop, ExprIf, ExprMatch, ExprWhile, Item, Pat, Stmt, UseTree};

use super::super::graph::Operation;
use super::value::{Truth, Value, Written};
use super::{Leaving, Lowering, Result, Returned, refuse};

impl Lowering<'_> {
    /// Runs a block; its value is that of its tail.
    pub fn block(&mut self, block: &Block) -> Result<Value> {
        let outside = self.locals.len();
        let mut value = Value::unit();
        for statement in &block.stmts {
            if self.is_leaving() {
                break;
            }
            value = self.statement(statement)?;
        }
        self.locals.truncate(outside);
        Ok(value)
    }

    /// Whether what follows is not run.
    fn is_leaving(&self) -> bool {
        self.leaving.is_some() || matches!(self.returned, Returned::Always(_))
    }

    fn statement(&mut self, statement: &Stmt) -> Result<Value> {
        match statement {
            Stmt::Local(local) => {
                let Some(init) = &local.init else {
                    // Its value comes later; a place must stand for it until then.
                    return self.bind(&local.pat, Value::unit()).map(|()| Value::unit());
                };
                if let Some((word, _)) = &init.diverge {
                    return refuse(word, "`let … else` cannot be followed at compile time");
                }
                let value = match &local.pat {
                    Pat::Type(typed) => self.with_expected(&typed.ty, |this| this.expression(&init.expr))?,
                    _ => self.expression(&init.expr)?,
                };
                self.bind(&local.pat, value)?;
                Ok(Value::unit())
            }
            Stmt::Expr(expression, None) => self.expression(expression),
            Stmt::Expr(expression, Some(_)) => self.expression(expression).map(|_| Value::unit()),
            Stmt::Item(Item::Use(import)) => {
                let root = import.leading_colon.map(|colons| quote!(#colons)).unwrap_or_default();
                self.import(root, &import.tree)?;
                Ok(Value::unit())
            }
            Stmt::Item(item) => {
                refuse(item, "no items inside a body; make it a function or constant of the annotated block")
            }
            Stmt::Macro(statement) => {
                refuse(&statement.mac, "macros hide what they compute; write the expression out")
            }
        }
    }

    /// Names that a `use` brings into a body, as the paths they stand for: the generated code is outside its scope.
    fn import(&mut self, path: TokenStream, tree: &UseTree) -> Result<()> {
        let (name, path) = match tree {
            UseTree::Path(inner) => {
                let name = &inner.ident;
                return self.import(quote!(#path #name ::), &inner.tree);
            }
            UseTree::Group(group) => {
                return group.items.iter().try_for_each(|tree| self.import(path.clone(), tree));
            }
            UseTree::Name(inner) => {
                let name = &inner.ident;
                (name, quote!(#path #name))
            }
            UseTree::Rename(inner) => {
                let name = &inner.ident;
                (&inner.rename, quote!(#path #name))
            }
            other => return refuse(other, "what a `*` imports is not known here; name what is used"),
        };
        self.locals.push((name.to_string(), Value::Written(Written::leaf(path))));
        Ok(())
    }

    pub fn choice(&mut self, choice: &ExprIf) -> Result<Value> {
        let condition = self.expression(&choice.cond)?;
        let otherwise = |this: &mut Self| match &choice.else_branch {
            Some((_, otherwise)) => this.expression(otherwise),
            None => Ok(Value::unit()),
        };
        let condition = match self.truth(&choice.cond, condition)? {
            Truth::Known(true) => return self.block(&choice.then_branch),
            Truth::Known(false) => return otherwise(self),
            Truth::Where(condition) => condition,
        };
        // Both branches start from the same locals; where they end differently, the condition selects.
        let before = self.locals.clone();
        let returned_before = self.returned.clone();
        let a = self.block(&choice.then_branch)?;
        let locals_a = std::mem::replace(&mut self.locals, before);
        let returned_a = std::mem::replace(&mut self.returned, returned_before);
        let b = otherwise(self)?;
        if self.leaving.is_some() {
            return refuse(
                &choice.cond,
                "a loop that numbers decide to leave cannot be written out; select a value with `if` instead",
            );
        }
        let always = [&returned_a, &self.returned].map(|returned| matches!(returned, Returned::Always(_)));
        let locals_b = std::mem::take(&mut self.locals);
        let value = match always {
            [true, _] => {
                self.locals = locals_b;
                b
            }
            [_, true] => {
                self.locals = locals_a;
                a
            }
            _ => {
                for ((name, a), (_, b)) in locals_a.into_iter().zip(locals_b) {
                    let value = self.select(&choice.cond, condition, a, b)?;
                    self.locals.push((name, value));
                }
                self.select(choice, condition, a, b)?
            }
        };
        let returned_b = std::mem::replace(&mut self.returned, Returned::Never);
        self.returned = self.joined(choice, condition, returned_a, returned_b)?;
        Ok(value)
    }

    /// What has been returned after both branches.
    fn joined(&mut self, at: &ExprIf, condition: super::Node, a: Returned, b: Returned) -> Result<Returned> {
        let parts = |returned| match returned {
            Returned::Never => (Truth::Known(false), None),
            Returned::Where(node, value) => (Truth::Where(node), Some(value)),
            Returned::Always(value) => (Truth::Known(true), Some(value)),
        };
        let ((where_a, a), (where_b, b)) = (parts(a), parts(b));
        let value = match (a, b) {
            (None, None) => return Ok(Returned::Never),
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

    pub fn match_known(&mut self, choice: &ExprMatch) -> Result<Value> {
        let value = self.expression(&choice.expr)?;
        for arm in &choice.arms {
            if !self.matches(&arm.pat, &value)? {
                continue;
            }
            let outside = self.locals.len();
            if let Pat::Ident(_) | Pat::Tuple(_) = &arm.pat
                && !has_literal(&arm.pat)
            {
                self.bind(&arm.pat, value.clone())?;
            }
            let value = self.expression(&arm.body);
            self.locals.truncate(outside);
            return value;
        }
        refuse(choice, "no arm matches")
    }

    pub fn for_loop(&mut self, each: &ExprForLoop) -> Result<Value> {
        if let Some(label) = &each.label {
            return refuse(label, "labelled loops cannot be followed at compile time");
        }
        let entries = self.expression(&each.expr)?;
        let Value::Sequence(entries) = entries else {
            return refuse(
                &each.expr,
                "the number of turns is not known here; loop over a range with constant bounds, or over an array whose type is written out",
            );
        };
        for entry in entries {
            let outside = self.locals.len();
            self.bind(&each.pat, entry)?;
            self.block(&each.body)?;
            self.locals.truncate(outside);
            if self.leaving.take() == Some(Leaving::Break) || self.is_leaving() {
                break;
            }
        }
        Ok(Value::unit())
    }

    pub fn while_loop(&mut self, repeated: &ExprWhile) -> Result<Value> {
        loop {
            self.count(&repeated.cond)?;
            let condition = self.expression(&repeated.cond)?;
            match self.truth(&repeated.cond, condition)? {
                Truth::Known(true) => {}
                Truth::Known(false) => return Ok(Value::unit()),
                Truth::Where(_) => {
                    return refuse(
                        &repeated.cond,
                        "a loop that numbers decide to leave cannot be written out; use a `for` loop over a constant range",
                    );
                }
            }
            self.block(&repeated.body)?;
            if self.leaving.take() == Some(Leaving::Break) || self.is_leaving() {
                return Ok(Value::unit());
            }
        }
    }

    /// `return`, `break`, `continue`.
    pub fn departure(&mut self, expression: &Expr) -> Result<Value> {
        match expression {
            Expr::Return(departure) => {
                let value = match &departure.expr {
                    Some(value) => self.expression(value)?,
                    None => Value::unit(),
                };
                self.returned = match std::mem::replace(&mut self.returned, Returned::Never) {
                    Returned::Never => Returned::Always(value),
                    // Where an earlier `return` was taken, its value stands.
                    Returned::Where(condition, earlier) => {
                        Returned::Always(self.select(expression, condition, earlier, value)?)
                    }
                    Returned::Always(earlier) => Returned::Always(earlier),
                };
            }
            Expr::Break(departure) if departure.expr.is_none() && departure.label.is_none() => {
                self.leaving = Some(Leaving::Break);
            }
            Expr::Continue(departure) if departure.label.is_none() => self.leaving = Some(Leaving::Continue),
            other => return refuse(other, "this departure cannot be followed at compile time"),
        }
        Ok(Value::unit())
    }
}

/// Whether the pattern holds literals, and so binds nothing that an arm could use.
fn has_literal(pattern: &Pat) -> bool {
    match pattern {
        Pat::Lit(_) | Pat::Range(_) | Pat::Or(_) => true,
        Pat::Tuple(tuple) => tuple.elems.iter().any(has_literal),
        _ => false,
    }
}
