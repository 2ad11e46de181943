//! Doubts about a rewritten body: types that it does not tell.

use syn::visit::{self, Visit};
use syn::{Expr, ImplItemFn, Local};

use crate::rayleigh_system::syntax::is_place_of_self;

/// Whether a field goes into a local as it stands, as in `let law = self.law;`: a number or an array can be
/// lifted, an enum or a struct cannot, and nothing here tells which it is.
pub fn hands_on_fields(function: &ImplItemFn) -> bool {
    let mut fields = Fields { found: false };
    fields.visit_impl_item_fn(function);
    fields.found
}

struct Fields {
    found: bool,
}

impl Fields {
    fn look_at(&mut self, value: &Expr) {
        match value {
            Expr::Reference(reference) => self.look_at(&reference.expr),
            Expr::Paren(inner) => self.look_at(&inner.expr),
            value => self.found |= is_place_of_self(value),
        }
    }
}

impl<'ast> Visit<'ast> for Fields {
    fn visit_local(&mut self, local: &'ast Local) {
        if let Some(init) = &local.init {
            self.look_at(&init.expr);
        }
        visit::visit_local(self, local);
    }

    fn visit_expr_assign(&mut self, assignment: &'ast syn::ExprAssign) {
        self.look_at(&assignment.right);
        visit::visit_expr_assign(self, assignment);
    }
}
