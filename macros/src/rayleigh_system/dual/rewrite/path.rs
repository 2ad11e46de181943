//! Paths: functions that have twins, functions of the scalar, constants.

use syn::visit_mut;
use syn::{Expr, ExprPath, FnArg, Ident, Path, parse_quote, parse_quote_spanned};

use super::{Rewriter, over};
use crate::rayleigh_system::diagnostics::{Mistake, span_of};
use crate::rayleigh_system::functions::is_known;
use crate::rayleigh_system::model::Source;
use crate::rayleigh_system::syntax::{has_floats, is_constant_name, is_function_of_std, is_variant, jumps};

impl Rewriter<'_> {
    /// A path that is called.
    pub fn called_path(&mut self, path: &mut ExprPath, without_arguments: bool) -> Option<Expr> {
        if let Some(replacement) = self.function_of_block(&path.path, without_arguments) {
            return Some(replacement);
        }
        if let Some(replacement) = self.function_of_scalar(&path.path) {
            return Some(replacement);
        }
        let last = path.path.segments.last()?.ident.to_string();
        let is_local = path.path.get_ident().is_some_and(|name| self.bound.contains(&name.to_string()));
        if is_variant(&path.path) {
            self.report.at(&path.path, Mistake::VariantByDuals);
            return None;
        }
        let is_constructor = last.starts_with(char::is_uppercase);
        if is_local || is_constructor || is_function_of_std(&path.path) {
            visit_mut::visit_expr_path_mut(self, path);
        } else if path.path.get_ident().is_some_and(|name| self.is_function_of_block(name)) {
            let takes_self = self
                .system
                .source
                .functions()
                .any(|function| function.sig.ident == last && function.sig.receiver().is_some());
            let call = if takes_self { format!("self.{last}(…)") } else { format!("Self::{last}(…)") };
            self.report.at(&path.path, Mistake::WithoutSelf { name: last, call });
        } else if path.path.get_ident().is_some() && is_known(&last) {
            let scalar = self.system.scalar.to_string();
            self.report.at(&path.path, Mistake::MethodAsFunction { method: last, scalar });
        } else {
            let segments: Vec<_> =
                path.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
            let mistake = match self.system.source {
                Source::Block(_) => Mistake::OutsideFunction { path: segments.join("::"), name: last },
                Source::Function(_) => Mistake::OutsideOfFunction {
                    path: segments.join("::"),
                    name: last,
                    scalar: self.system.scalar.to_string(),
                },
            };
            self.report.at(&path.path, mistake);
        }
        None
    }

    /// A path that stands as a value: a local, a constant, or a function handed on.
    pub fn path(&mut self, path: &mut ExprPath) -> Option<Expr> {
        if path.path.is_ident("self") {
            self.report.at(path, Mistake::BareSelf);
            return None;
        }
        if path.path.get_ident().is_some_and(|name| self.bound.contains(&name.to_string())) {
            return None;
        }
        if let Some(replacement) = self.function_of_block(&path.path, false) {
            return Some(replacement);
        }
        let last = &path.path.segments.last()?.ident;
        // It is of every type; lifted, it would be of none that rustc knows.
        if path.path.is_ident("None") {
            return None;
        }
        if is_constant_name(last) {
            if self.system.source.integer_constants().any(|constant| constant == last) {
                return None;
            }
            let span = span_of(path);
            return Some(parse_quote_spanned!(span=> D::lift(#path)));
        }
        if path.path.segments.len() > 1 && is_variant(&path.path) {
            self.report.at(path, Mistake::VariantByDuals);
            return None;
        }
        if let Some(replacement) = self.function_of_scalar(&path.path) {
            return Some(replacement);
        }
        if path.qself.is_some() || is_function_of_std(&path.path) {
            return self.called_path(path, false);
        }
        // A constant of the module, or a misspelled local: rustc knows better which one was meant.
        let span = span_of(path);
        Some(parse_quote_spanned!(span=> D::lift(#path)))
    }

    /// `Self::square` → `Self::square_over`.
    pub fn function_of_block(&mut self, path: &Path, without_arguments: bool) -> Option<Expr> {
        let mut segments = path.segments.iter();
        let (first, last) = (segments.next()?, segments.next()?);
        let is_system = first.ident == "Self" || first.ident == self.system.name;
        if segments.next().is_some() || !is_system || !self.is_function_of_block(&last.ident) {
            return None;
        }
        self.functions.push(last.ident.clone());
        let says_nothing = without_arguments || self.takes_no_float(&last.ident);
        let name = over(&last.ident);
        let first = &first.ident;
        Some(if says_nothing { parse_quote!(#first::#name::<D>) } else { parse_quote!(#first::#name) })
    }

    /// `f64::sin` → `Real::<D>::sin`.
    pub fn function_of_scalar(&mut self, path: &Path) -> Option<Expr> {
        let mut segments = path.segments.iter().rev();
        let (last, first) = (segments.next()?, segments.next()?);
        // `core::primitive::f64::sin`, or no module at all.
        let in_module = segments.next().is_some_and(|module| module.ident != "primitive");
        if in_module || first.ident != self.system.scalar || is_constant_name(&last.ident) {
            return None;
        }
        if jumps(&last.ident) {
            self.report.at(path, Mistake::Rounding(last.ident.to_string()));
        }
        let span = first.ident.span();
        Some(parse_quote_spanned!(span=> Real::<D>::#last))
    }

    /// Whether the arguments of a function of the block leave open what numbers it works on.
    pub fn takes_no_float(&self, name: &Ident) -> bool {
        let function = self.system.source.functions().find(|function| function.sig.ident == *name);
        function.is_some_and(|function| {
            function.sig.inputs.iter().all(|parameter| match parameter {
                FnArg::Typed(parameter) => !has_floats(&parameter.ty),
                FnArg::Receiver(_) => true,
            })
        })
    }

    pub fn is_function_of_block(&self, name: &Ident) -> bool {
        self.system.source.functions().any(|function| function.sig.ident == *name)
    }
}
