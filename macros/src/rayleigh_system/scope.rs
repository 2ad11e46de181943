//! Names that a body binds: parameters, locals, closure parameters.

use std::collections::HashSet;

use syn::visit::{self, Visit};
use syn::{ImplItemFn, PatIdent};

/// All names bound anywhere in the function. Scopes are not told apart: a name bound once is a local
/// everywhere.
pub fn bound_names(function: &ImplItemFn) -> HashSet<String> {
    let mut names = Names::default();
    names.visit_impl_item_fn(function);
    names.bound
}

#[derive(Default)]
struct Names {
    bound: HashSet<String>,
}

impl<'ast> Visit<'ast> for Names {
    fn visit_pat_ident(&mut self, pattern: &'ast PatIdent) {
        self.bound.insert(pattern.ident.to_string());
        visit::visit_pat_ident(self, pattern);
    }
}
