//! Casts and functions that jump: of what does not depend on q and v they are left to rustc.

use syn::{
    BinOp, Expr, ExprCall, ExprCast, ExprMethodCall, ExprPath, Ident, Type, UnOp, parse_quote_spanned,
    visit_mut,
};

use super::Rewriter;
use super::method::may_be_of_ones_own;
use crate::rayleigh_system::diagnostics::{Mistake, span_of};
use crate::rayleigh_system::functions::is_known;
use crate::rayleigh_system::syntax::{is_arithmetic, is_constant_name, is_self, without_parentheses};
use crate::rayleigh_system::syntax::{is_integer, jumps, simple_name};

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

    /// `f64::from(self.c)` → `D::real(f64::from(self.c))`, whatever the type of `self.c`.
    pub fn conversion(&self, call: &ExprCall) -> Option<Expr> {
        let is_constant =
            is_from(&call.func, &self.system.scalar) && call.args.iter().all(|value| self.is_constant(value));
        let span = span_of(&call.func);
        is_constant.then(|| parse_quote_spanned!(span=> D::real(#call)))
    }

    /// `self.k.curve()` → `D::lift(self.k.curve())`, for a method of the user's.
    pub fn of_constants(&self, call: &ExprMethodCall) -> Option<Expr> {
        let is_constant = may_be_of_ones_own(&call.method)
            && self.is_constant(&call.receiver)
            && call.args.iter().all(|argument| self.is_constant(argument));
        let span = call.method.span();
        is_constant.then(|| parse_quote_spanned!(span=> D::lift(#call)))
    }

    /// The receiver in `self.c.max(0.5).into()`, `D::lift(self.c.max(0.5))`, whatever its type.
    pub fn converted(&self, call: &ExprMethodCall) -> Option<Expr> {
        let receiver = &call.receiver;
        let is_constant = call.method == "into" && !is_of_literals(receiver) && self.is_constant(receiver);
        let span = span_of(receiver);
        is_constant.then(|| parse_quote_spanned!(span=> D::lift(#receiver)))
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
    pub fn is_constant(&self, expression: &Expr) -> bool {
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
                let may_be_plain = jumps(&call.method)
                    || is_known(&call.method.to_string())
                    || may_be_of_ones_own(&call.method);
                may_be_plain
                    && self.is_constant(&call.receiver)
                    && call.args.iter().all(|argument| self.is_constant(argument))
            }
            Expr::Call(call) => {
                let scalar = &self.system.scalar;
                let jumps = match &*call.func {
                    Expr::Path(path) => {
                        let segments = &path.path.segments;
                        segments.len() == 2 && segments[0].ident == *scalar && jumps(&segments[1].ident)
                    }
                    _ => false,
                };
                (jumps || is_from(&call.func, scalar))
                    && call.args.iter().all(|argument| self.is_constant(argument))
            }
            Expr::Field(field) => is_self(&field.base) || self.is_constant(&field.base),
            // A local that is an index is an integer.
            Expr::Index(entry) => {
                self.is_constant(&entry.expr)
                    && (self.is_constant(&entry.index) || matches!(*entry.index, Expr::Path(_)))
            }
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

/// `f64::from`, `<f64>::from`, `<f64 as From<f32>>::from`.
pub fn is_from(function: &Expr, scalar: &Ident) -> bool {
    let Expr::Path(ExprPath { qself, path, .. }) = function else { return false };
    let of_scalar = |ty: &Type| simple_name(ty).is_some_and(|name| name == scalar);
    let mut segments = path.segments.iter().rev();
    let (last, before) = (segments.next(), segments.next());
    last.is_some_and(|last| last.ident == "from")
        && match (qself, before) {
            (Some(qself), None) => of_scalar(&qself.ty),
            (Some(qself), Some(from)) => of_scalar(&qself.ty) && from.ident == "From",
            (None, before) => before.is_some_and(|ty| ty.ident == *scalar),
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
