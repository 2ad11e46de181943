//! Fields: lifted one number, array or tuple at a time, since nothing stands for a struct over dual numbers.

use syn::{Expr, ExprField, Ident, Member, parse_quote_spanned};

use super::{Field, Rewriter};
use crate::rayleigh_system::diagnostics::{Mistake, span_of};
use crate::rayleigh_system::hygiene::unmarked;
use crate::rayleigh_system::syntax::{identifier, is_self, without_parentheses};

impl Rewriter<'_> {
    /// The expression in place of `base.member`, where that is a field of the system.
    ///
    /// | written | becomes |
    /// |---|---|
    /// | `self.outer.inner.k` | `outer_inner_k`, with `let outer_inner_k = D::lift(self.outer.inner.k);` at the top |
    /// | `self.springs[i].k` | `D::lift(self.springs[i].k)` |
    /// | `pair.0` | itself |
    /// | `spring.k` | refused: it belongs to a struct |
    pub fn field_access(&mut self, field: &mut ExprField) -> Option<Expr> {
        if let Some(members) = members_of_self(field) {
            let local = self.field(&members, field.clone());
            return Some(Expr::Path(parse_quote_spanned!(local.span()=> #local)));
        }
        if self.is_entry_of_self(&mut field.base) {
            let span = span_of(&field.member);
            return Some(parse_quote_spanned!(span=> D::lift(#field)));
        }
        // Where the struct came from, something may have been said already.
        if let Member::Named(name) = &field.member
            && self.report.is_empty()
            && !matches!(*field.base, Expr::Struct(_))
        {
            self.report.at(name, Mistake::StructByDuals);
        }
        None
    }

    /// Whether the place is an entry of an array of the system; its indices are rewritten if so.
    fn is_entry_of_self(&mut self, place: &mut Expr) -> bool {
        match place {
            Expr::Field(field) => is_self(&field.base) || self.is_entry_of_self(&mut field.base),
            Expr::Paren(inner) => self.is_entry_of_self(&mut inner.expr),
            Expr::Index(entry) => {
                let is_of_self = self.is_entry_of_self(&mut entry.expr);
                if is_of_self {
                    syn::visit_mut::VisitMut::visit_expr_mut(self, &mut entry.index);
                }
                is_of_self
            }
            _ => false,
        }
    }

    /// The local that holds a field.
    fn field(&mut self, members: &[Member], access: ExprField) -> Ident {
        let words: Vec<String> = members
            .iter()
            .map(|member| match member {
                Member::Named(name) => name.to_string(),
                Member::Unnamed(index) => index.index.to_string(),
            })
            .collect();
        let name = match &words[..] {
            // A keyword may be a field's name, and nothing's that is made of it.
            [word] if !word.starts_with(|c: char| c.is_ascii_digit()) => word.clone(),
            words => {
                let joined =
                    words.iter().map(|word| word.trim_start_matches("r#")).collect::<Vec<_>>().join("_");
                if joined.starts_with(|c: char| c.is_ascii_digit()) {
                    format!("field_{joined}")
                } else {
                    joined
                }
            }
        };
        // A local of the same name keeps it: the field becomes `self_k`, and `self_k_` if there is that one
        // too.
        let mut free = name;
        if self.is_taken(&free, &words) {
            free = format!("self_{}", free.trim_start_matches("r#"));
        }
        while self.is_taken(&free, &words) {
            free.push('_');
        }
        let span = span_of(&access.member);
        let field =
            self.fields.entry(words).or_insert_with(|| Field { local: identifier(&free, span), access });
        let mut local = field.local.clone();
        local.set_span(span);
        local
    }

    /// Whether a local of the body, or another field, has the name.
    fn is_taken(&self, name: &str, words: &[String]) -> bool {
        self.bound.iter().any(|bound| unmarked(bound) == name)
            || self.fields.iter().any(|(others, field)| others != words && field.local == *name)
    }
}

/// The members from `self` to the field; nothing where anything else stands between.
fn members_of_self(field: &ExprField) -> Option<Vec<Member>> {
    let mut members = if is_self(&field.base) {
        Vec::new()
    } else {
        match without_parentheses(&field.base) {
            Expr::Field(outer) => members_of_self(outer)?,
            _ => return None,
        }
    };
    members.push(field.member.clone());
    Some(members)
}
