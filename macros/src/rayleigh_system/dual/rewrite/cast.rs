//! Casts and functions that jump: of what does not depend on q and v they are left to rustc.

use syn::{BinOp, Expr, ExprCast, UnOp, parse_quote_spanned, visit_mut};

use super::Rewriter;
use crate::rayleigh_system::diagnostics::{Mistake, span_of};
use crate::rayleigh_system::syntax::{METHODS, is_integer, jumps, simple_name};
use crate::rayleigh_system::syntax::{is_arithmetic, is_constant_name, is_self, without_parentheses};

impl Rewriter<'_> {
    /// | written | becomes |
    /// |---|---|
    /// | `2.7 as u8`, `self.k as u8` | itself |
    /// | `i as usize` | `dual::integer::<_, usize>(i)`: for integers alone |
    /// | `1.1_f32 as f64` | `D::real(1.1_f32 as f64)` |
    /// | `i as f64` | `D::number(i)` |
    pub fn cast(&mut self, cast: &mut ExprCast) -> Option<Expr> {
        let is_constant = self.is_constant(&cast.expr);
        let span = cast.as_token.span;
        let to_scalar = simple_name(&cast.ty).is_some_and(|name| *name == self.system.scalar);
        if is_constant && is_integer(&cast.ty) {
            return None;
        }
        if is_constant && to_scalar {
            return Some(parse_quote_spanned!(span=> D::real(#cast)));
        }
        if is_integer(&cast.ty) {
            visit_mut::VisitMut::visit_expr_mut(self, &mut cast.expr);
            let ExprCast { expr, ty, .. } = &*cast;
            let expr = without_parentheses(expr);
            return Some(parse_quote_spanned!(span=> dual::integer::<_, #ty>(#expr)));
        }
        match simple_name(&cast.ty) {
            _ if to_scalar => {
                visit_mut::VisitMut::visit_expr_mut(self, &mut cast.expr);
                let expr = without_parentheses(&cast.expr);
                let span = span_of(expr);
                Some(parse_quote_spanned!(span=> D::number(#expr)))
            }
            Some(name) if name == "f64" || name == "f32" => {
                let expected = self.system.scalar.to_string();
                self.report.at(&cast.ty, Mistake::OtherFloat { expected });
                None
            }
            _ => {
                visit_mut::visit_expr_cast_mut(self, cast);
                None
            }
        }
    }

    /// `self.k.floor()` → `D::lift(self.k.floor())`, and the remainder `self.k % 2.0` so too.
    pub fn constant_that_jumps(&self, expression: &Expr) -> Option<Expr> {
        let (operands, span) = match expression {
            Expr::MethodCall(call) if jumps(&call.method) => (vec![&*call.receiver], call.method.span()),
            Expr::Call(call) => (call.args.iter().collect(), span_of(&call.func)),
            Expr::Binary(binary) if matches!(binary.op, BinOp::Rem(_)) => {
                (vec![&*binary.left, &*binary.right], span_of(&binary.op))
            }
            _ => return None,
        };
        // Of literals alone the type would not show.
        let is_typed = operands.iter().any(|operand| !is_of_literals(operand));
        (is_typed && self.is_constant(expression)).then(|| parse_quote_spanned!(span=> D::lift(#expression)))
    }

    /// Whether the expression is made of literals, fields and constants alone, by arithmetic, casts and
    /// methods of numbers: the same over plain numbers.
    fn is_constant(&self, expression: &Expr) -> bool {
        match expression {
            Expr::Lit(_) => true,
            Expr::Paren(inner) => self.is_constant(&inner.expr),
            Expr::Group(inner) => self.is_constant(&inner.expr),
            Expr::Cast(cast) => self.is_constant(&cast.expr),
            Expr::Unary(unary) => matches!(unary.op, UnOp::Neg(_)) && self.is_constant(&unary.expr),
            Expr::Binary(binary) => {
                (is_arithmetic(&binary.op) || matches!(binary.op, BinOp::Rem(_)))
                    && self.is_constant(&binary.left)
                    && self.is_constant(&binary.right)
            }
            Expr::MethodCall(call) => {
                (jumps(&call.method) || METHODS.iter().any(|method| call.method == method))
                    && self.is_constant(&call.receiver)
                    && call.args.iter().all(|argument| self.is_constant(argument))
            }
            Expr::Call(call) => {
                let segments = match &*call.func {
                    Expr::Path(path) => &path.path.segments,
                    _ => return false,
                };
                segments.len() == 2
                    && segments[0].ident == self.system.scalar
                    && jumps(&segments[1].ident)
                    && call.args.iter().all(|argument| self.is_constant(argument))
            }
            Expr::Field(field) => is_self(&field.base) || self.is_constant(&field.base),
            Expr::Index(entry) => self.is_constant(&entry.expr) && self.is_constant(&entry.index),
            Expr::Path(path) => path.path.segments.last().is_some_and(|last| {
                let is_local =
                    path.path.get_ident().is_some_and(|name| self.bound.contains(&name.to_string()));
                let is_small = last.ident.to_string().starts_with(char::is_lowercase);
                !is_local && !is_self(expression) && (is_constant_name(&last.ident) || is_small)
            }),
            _ => false,
        }
    }
}

/// Whether the expression is arithmetic of literals.
fn is_of_literals(expression: &Expr) -> bool {
    match expression {
        Expr::Lit(_) => true,
        Expr::Paren(inner) => is_of_literals(&inner.expr),
        Expr::Group(inner) => is_of_literals(&inner.expr),
        Expr::Unary(unary) => is_of_literals(&unary.expr),
        Expr::Binary(binary) => is_of_literals(&binary.left) && is_of_literals(&binary.right),
        _ => false,
    }
}
