//! Calls: of functions and methods that have twins, and of those of the standard library.

use syn::visit_mut::VisitMut;
use syn::{Expr, ExprCall, ExprMethodCall, Ident, Path, parse_quote, parse_quote_spanned};

use super::cast::is_from;
use super::{Rewriter, over};
use crate::rayleigh_system::diagnostics::Mistake;
use crate::rayleigh_system::syntax::{ROUNDING, is_constant_name, is_self, takes_function};

impl Rewriter<'_> {
    pub fn method_call(&mut self, call: &mut ExprMethodCall, has_value: bool) {
        if is_self(&call.receiver) {
            if self.is_function_of_block(&call.method) {
                self.functions.push(call.method.clone());
                let says_nothing = call.args.is_empty() || self.takes_no_float(&call.method);
                call.method = over(&call.method);
                if says_nothing {
                    call.turbofish = Some(parse_quote!(::<D>));
                }
            } else {
                self.report.at(&call.method, Mistake::OutsideMethod(call.method.to_string()));
            }
        } else {
            if ROUNDING.iter().any(|rounding| call.method == rounding) {
                self.report.at(&call.method, Mistake::Rounding(call.method.to_string()));
            }
            if has_value {
                self.own_methods.note(call, &self.numbers);
            }
            match self.converted(call) {
                Some(receiver) => *call.receiver = receiver,
                None => self.visit_expr_mut(&mut call.receiver),
            }
        }
        if let Some(turbofish) = &mut call.turbofish
            && !is_self(&call.receiver)
        {
            self.visit_angle_bracketed_generic_arguments_mut(turbofish);
        }
        for argument in &mut call.args {
            // `.map(square)`: a name that is no local is a function handed on, which must be one of the
            // block.
            match argument {
                Expr::Path(path) if takes_function(&call.method) && self.is_unknown(&path.path) => {
                    if let Some(replacement) = self.called_path(path, false) {
                        *argument = replacement;
                    }
                }
                _ => self.visit_expr_mut(argument),
            }
        }
    }

    /// `self.drag.at(x)` → `dual::at(&self.drag, x)`, of a characteristic that a field or constant is.
    pub fn characteristic(&mut self, call: &mut ExprMethodCall) -> Option<Expr> {
        let is_one = call.method == "at" && call.args.len() == 1 && self.is_constant(&call.receiver);
        is_one.then(|| {
            let (receiver, x) = (call.receiver.clone(), &mut call.args[0]);
            self.visit_expr_mut(x);
            parse_quote_spanned!(call.method.span()=> dual::at(&#receiver, #x))
        })
    }

    /// A name in small letters that is bound nowhere in the body, or a path to one.
    fn is_unknown(&self, path: &Path) -> bool {
        let is_bound = path.get_ident().is_some_and(|name| self.bound.contains(&name.to_string()));
        let is_small =
            |name: &Ident| !is_constant_name(name) && !name.to_string().starts_with(char::is_uppercase);
        !is_bound && !path.is_ident("self") && path.segments.last().is_some_and(|last| is_small(&last.ident))
    }

    pub fn call(&mut self, call: &mut ExprCall) {
        // In `f64::from(if on { self.c } else { 1.5 })` the literal may be of another precision.
        self.is_doubtful |= is_from(&call.func, &self.system.scalar) && !call.args.iter().all(is_place);
        match &mut *call.func {
            Expr::Path(path) => {
                let without_arguments = call.args.is_empty();
                if let Some(replacement) = self.called_path(path, without_arguments) {
                    *call.func = replacement;
                }
            }
            function => self.visit_expr_mut(function),
        }
        for argument in &mut call.args {
            // `Self::height(self, q)` hands the system on; its fields are lifted there.
            if !is_self(argument) {
                self.visit_expr_mut(argument);
            }
        }
    }
}

/// A local, a field or an entry, behind a `*` or not.
fn is_place(value: &Expr) -> bool {
    match value {
        Expr::Unary(unary) => is_place(&unary.expr),
        value => matches!(value, Expr::Path(_) | Expr::Index(_) | Expr::Field(_)),
    }
}
