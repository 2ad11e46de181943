//! Blocks with a label: `break 'found x` gives their value, as `return` does that of a function.

use syn::visit::{self, Visit};
use syn::{Block, Expr, ExprReturn, Label};

use super::value::Value;
use super::{Lowering, Result, Returned};

impl Lowering<'_> {
    /// Runs a block that `break` may end. Numbers may decide whether, where nothing outside is changed.
    pub fn labelled_block(&mut self, label: &Label, block: &Block) -> Result<Value> {
        let label = label.name.to_string();
        let value = if returns(block) { self.block(block)? } else { self.as_a_body(&label, block)? };
        match self.leaving.take() {
            Some(leaving) if leaving.label.as_ref() == Some(&label) => Ok(leaving.value),
            leaving => {
                self.leaving = leaving;
                Ok(value)
            }
        }
    }

    /// The block as the body of a function that sees the locals here.
    fn as_a_body(&mut self, label: &str, block: &Block) -> Result<Value> {
        let captured = std::mem::replace(&mut self.captured, self.locals.len());
        let returned = std::mem::replace(&mut self.returned, Returned::Never);
        let guards = self.guards.len();
        self.labels.push(label.to_owned());
        let tail = self.block(block);
        self.labels.pop();
        self.guards.truncate(guards);
        self.captured = captured;
        match (std::mem::replace(&mut self.returned, returned), tail?) {
            (Returned::Never, tail) => Ok(tail),
            (Returned::Always(value), _) => Ok(value),
            (Returned::Where(condition, value), tail) => self.select(block, condition, value, tail),
        }
    }

    /// Whether `break` to the label ends what is run as a body.
    pub fn ends_body(&self, label: Option<&String>) -> bool {
        label.is_some() && self.labels.last() == label
    }
}

/// Whether the function may return from within the block.
fn returns(block: &Block) -> bool {
    struct Returns(bool);
    impl<'ast> Visit<'ast> for Returns {
        fn visit_expr_return(&mut self, _: &'ast ExprReturn) {
            self.0 = true;
        }
        fn visit_expr(&mut self, expression: &'ast Expr) {
            // A closure returns from itself.
            if !matches!(expression, Expr::Closure(_)) {
                visit::visit_expr(self, expression);
            }
        }
    }
    let mut returns = Returns(false);
    returns.visit_block(block);
    returns.0
}
