//! Bodies that give no value, such as `{}`: rustc says so of the user's function, in the user's types.

use syn::visit::{self, Visit};
use syn::{Expr, ImplItemFn, ReturnType, Stmt};

use super::functions::is_known;
use super::model::{Source, System};

/// Whether rustc surely refuses one of the functions, since it ends without the value that it owes.
pub fn is_owed_in(source: &Source, system: &System<'_>) -> bool {
    system.bodies.iter().map(|body| &body.function).chain(source.functions()).any(is_owed)
}

fn is_owed(function: &ImplItemFn) -> bool {
    let ends_without = match function.block.stmts.last() {
        None => true,
        Some(Stmt::Local(_)) => true,
        Some(Stmt::Expr(_, semicolon)) => semicolon.is_some(),
        Some(Stmt::Item(_) | Stmt::Macro(_)) => false,
    };
    let mut escapes = Escapes { found: false };
    escapes.visit_block(&function.block);
    ends_without && !escapes.found && matches!(function.sig.output, ReturnType::Type(..))
}

/// Expressions that may return, or never end: behind them no value is owed.
struct Escapes {
    found: bool,
}

impl<'ast> Visit<'ast> for Escapes {
    fn visit_expr(&mut self, expression: &'ast Expr) {
        self.found |= match expression {
            Expr::Return(_)
            | Expr::Loop(_)
            | Expr::While(_)
            | Expr::Call(_)
            | Expr::Macro(_)
            | Expr::Try(_) => true,
            Expr::Unsafe(_) | Expr::Async(_) | Expr::Verbatim(_) => true,
            Expr::MethodCall(call) => !is_known(&call.method.to_string()),
            _ => false,
        };
        visit::visit_expr(self, expression);
    }

    fn visit_stmt_macro(&mut self, _: &'ast syn::StmtMacro) {
        self.found = true;
    }
}
