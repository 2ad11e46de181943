//! Blocks, loops and departures from them.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Block, Expr, ExprForLoop, ExprLoop, ExprWhile, Item, Label, Lifetime, Pat, Stmt, Type, UseTree};

use super::mutable::Mutable;
use super::value::{Truth, Value};
use super::{Leaving, Lowering, Result, Returned, refuse};

impl Lowering<'_> {
    /// Runs a block; its value is that of its tail.
    pub fn block(&mut self, block: &Block) -> Result<Value> {
        self.statements(block, None)
    }

    /// [`block`](Self::block) where the type of the tail is written down.
    pub fn block_of_type(&mut self, block: &Block, ty: &Type) -> Result<Value> {
        self.statements(block, Some(ty))
    }

    fn statements(&mut self, block: &Block, ty: Option<&Type>) -> Result<Value> {
        let outside = self.locals.len();
        // A `use` is seen in the whole block.
        for statement in &block.stmts {
            if let Stmt::Item(Item::Use(import)) = statement {
                let root = import.leading_colon.map(|colons| quote!(#colons)).unwrap_or_default();
                self.import(root, &import.tree)?;
            }
        }
        let mut value = Value::unit();
        for statement in &block.stmts {
            if self.is_leaving() {
                self.integers.has_dead_code = true;
                break;
            }
            value = match (statement, ty) {
                (Stmt::Expr(tail, None), Some(ty)) => self.expression_of_type(tail, ty)?,
                _ => self.statement(statement)?,
            };
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
                    return self.declare(&local.pat);
                };
                let value = match &local.pat {
                    Pat::Type(typed) => self.expression_of_type(&init.expr, &typed.ty)?,
                    _ => self.expression(&init.expr)?,
                };
                match &init.diverge {
                    Some((_, otherwise)) => self.let_else(&local.pat, &value, otherwise)?,
                    None => self.bind(&local.pat, value)?,
                }
                Ok(Value::unit())
            }
            Stmt::Expr(expression, None) => self.expression(expression),
            Stmt::Expr(expression, Some(_)) => self.expression(expression).map(|_| Value::unit()),
            Stmt::Item(Item::Use(_)) => Ok(Value::unit()),
            Stmt::Item(item) => {
                refuse(item, "no items inside a body; make it a function or constant of the annotated block")
            }
            Stmt::Macro(statement) => {
                let value = self.matches_macro(&statement.mac)?;
                Ok(if statement.semi_token.is_some() { Value::unit() } else { value })
            }
        }
    }

    /// `let x;`
    fn declare(&mut self, pattern: &Pat) -> Result<Value> {
        match pattern {
            Pat::Type(typed) => self.declare(&typed.pat),
            Pat::Ident(name) if name.subpat.is_none() => {
                self.locals.push((name.ident.to_string(), Value::Unset));
                Ok(Value::unit())
            }
            other => refuse(other, "declare one name at a time, or give it a value"),
        }
    }

    /// Names that a `use` brings into a body, as the paths they stand for: the generated code is outside its
    /// scope.
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
        self.locals.push((name.to_string(), Value::Import(path)));
        Ok(())
    }

    pub fn for_loop(&mut self, each: &ExprForLoop) -> Result<Value> {
        if let Some(mutable) = Mutable::of(&each.expr, &each.pat) {
            return self.for_each_place(each, &mutable);
        }
        let entries = self.expression(&each.expr)?;
        let Value::Sequence(entries) = entries else {
            return refuse(
                &each.expr,
                "the number of turns is not known here; loop over a range with constant bounds, or over an array whose type is written out",
            );
        };
        self.integers.has_dead_code |= entries.is_empty();
        for entry in entries {
            self.count(&each.pat)?;
            let outside = self.locals.len();
            self.bind(&each.pat, entry)?;
            self.block(&each.body)?;
            self.locals.truncate(outside);
            if self.ends(each.label.as_ref()).is_some() {
                break;
            }
        }
        Ok(Value::unit())
    }

    pub fn while_loop(&mut self, repeated: &ExprWhile) -> Result<Value> {
        loop {
            self.count(&repeated.cond)?;
            let outside = self.locals.len();
            match self.condition(&repeated.cond)? {
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
            self.locals.truncate(outside);
            if self.ends(repeated.label.as_ref()).is_some() {
                return Ok(Value::unit());
            }
        }
    }

    pub fn endless_loop(&mut self, endless: &ExprLoop) -> Result<Value> {
        loop {
            self.count(&endless.loop_token)?;
            self.block(&endless.body)?;
            if let Some(value) = self.ends(endless.label.as_ref()) {
                return Ok(value);
            }
        }
    }

    /// After a turn of a loop: the loop's value if that was the last one.
    pub fn ends(&mut self, label: Option<&Label>) -> Option<Value> {
        let own = label.map(|label| label.name.to_string());
        match self.leaving.take() {
            Some(leaving) if leaving.label.is_none() || leaving.label == own => {
                leaving.is_break.then_some(leaving.value)
            }
            // On its way to a loop outside.
            Some(leaving) => {
                self.leaving = Some(leaving);
                Some(Value::unit())
            }
            None => matches!(self.returned, Returned::Always(_)).then(Value::unit),
        }
    }

    /// `return`, `break`, `continue`.
    pub fn departure(&mut self, expression: &Expr) -> Result<Value> {
        let label = |label: &Option<Lifetime>| label.as_ref().map(ToString::to_string);
        match expression {
            Expr::Return(departure) => {
                let value = match &departure.expr {
                    Some(value) => self.expression(value)?,
                    None => Value::unit(),
                };
                self.return_with(expression, value)?;
            }
            Expr::Break(departure) => {
                let value = match &departure.expr {
                    Some(value) => self.expression(value)?,
                    None => Value::unit(),
                };
                let label = label(&departure.label);
                if self.ends_body(label.as_ref()) {
                    self.return_with(expression, value)?;
                } else {
                    self.leaving = Some(Leaving { is_break: true, label, value });
                }
            }
            Expr::Continue(departure) => {
                let label = label(&departure.label);
                self.leaving = Some(Leaving { is_break: false, label, value: Value::unit() });
            }
            other => return refuse(other, "this departure cannot be followed at compile time"),
        }
        Ok(Value::unit())
    }

    /// Ends the body that is run with the value.
    fn return_with(&mut self, at: &Expr, value: Value) -> Result<()> {
        self.returned = match std::mem::replace(&mut self.returned, Returned::Never) {
            Returned::Never => Returned::Always(value),
            // Where an earlier `return` was taken, its value stands.
            Returned::Where(condition, earlier) => {
                Returned::Always(self.select(at, condition, earlier, value)?)
            }
            Returned::Always(earlier) => Returned::Always(earlier),
        };
        Ok(())
    }
}
