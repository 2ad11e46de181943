//! Operators over `Real<D>` take their operands as those of plain numbers do: by value, in the order written,
//! the place that is assigned to last of all. Rust's own rule for other types borrows before it evaluates.

use proc_macro2::Span;
use syn::{BinOp, Expr, ExprBinary, Ident, parse_quote_spanned};

use super::Rewriter;
use crate::rayleigh_system::diagnostics::span_of;
use crate::rayleigh_system::functions::is_known;
use crate::rayleigh_system::syntax::{is_assignment, is_self, without_parentheses};

impl Rewriter<'_> {
    /// The operator, whose operands are rewritten; it stays as it is where nothing can tell in which order
    /// they run.
    ///
    /// | written | becomes |
    /// |---|---|
    /// | `x += { x -= 1.0; x }` | `{ let right = { x -= 1.0; x }; x += right }` |
    /// | `x < { x -= 1.0; x }` | `{ let (left, right) = (x, { x -= 1.0; x }); left < right }` |
    /// | `i % n` | `dual::remainder(i % n)` |
    pub fn operator(&self, binary: &ExprBinary, is_still: bool) -> Option<Expr> {
        let ExprBinary { left, op, right, .. } = binary;
        let span = span_of(op);
        let [first, second] = ["left", "right"].map(|name| Ident::new(name, Span::mixed_site()));
        // The operator itself stays: through a function, the type of an integer literal would not be
        // inferred.
        match op {
            BinOp::Rem(_) => Some(parse_quote_spanned!(span=> dual::remainder(#left % #right))),
            BinOp::RemAssign(_) => {
                let right = without_parentheses(right);
                Some(match is_still {
                    true => parse_quote_spanned!(span=> #left = dual::remainder(#left % (#right))),
                    false => parse_quote_spanned! {span=>
                        {
                            let #second = #right;
                            let #first = &mut #left;
                            *#first = dual::remainder(*#first % #second)
                        }
                    },
                })
            }
            _ if is_still => None,
            op if is_assignment(op) => {
                let right = without_parentheses(right);
                Some(parse_quote_spanned!(span=> { let #second = #right; #left #op #second }))
            }
            BinOp::Eq(_) | BinOp::Ne(_) | BinOp::Lt(_) | BinOp::Le(_) | BinOp::Gt(_) | BinOp::Ge(_) => {
                Some(parse_quote_spanned! {span=>
                    { let (#first, #second) = (#left, #right); #first #op #second }
                })
            }
            _ => None,
        }
    }

    /// Whether running the expression changes no place: of calls, that is known of the block's functions and
    /// of numbers' methods alone.
    pub fn is_still(&self, expression: &Expr) -> bool {
        let all = |mut arguments: syn::punctuated::Iter<'_, Expr>| {
            arguments.all(|argument| is_self(argument) || self.is_still(argument))
        };
        match expression {
            Expr::Lit(_) | Expr::Path(_) => true,
            Expr::Paren(inner) => self.is_still(&inner.expr),
            Expr::Group(inner) => self.is_still(&inner.expr),
            Expr::Field(field) => self.is_still(&field.base),
            Expr::Index(entry) => self.is_still(&entry.expr) && self.is_still(&entry.index),
            Expr::Unary(unary) => self.is_still(&unary.expr),
            Expr::Reference(reference) => reference.mutability.is_none() && self.is_still(&reference.expr),
            Expr::Cast(cast) => self.is_still(&cast.expr),
            Expr::Array(array) => all(array.elems.iter()),
            Expr::Tuple(tuple) => all(tuple.elems.iter()),
            Expr::Binary(binary) => {
                !is_assignment(&binary.op) && self.is_still(&binary.left) && self.is_still(&binary.right)
            }
            Expr::MethodCall(call) => {
                let has_no_effect = is_self(&call.receiver) || is_known(&call.method.to_string());
                has_no_effect && self.is_still(&call.receiver) && all(call.args.iter())
            }
            Expr::Call(call) => match &*call.func {
                Expr::Path(path) => path.path.segments.len() > 1 && all(call.args.iter()),
                _ => false,
            },
            _ => false,
        }
    }
}
