//! `#[cfg]` and `#[cfg_attr]` inside the annotated item. An attribute macro sees its item before rustc takes
//! configured-out parts away, so that it would differentiate code that does not run.

use syn::Attribute;
use syn::visit::{self, Visit};

use super::diagnostics::{Mistake, Report};
use super::model::Source;

/// Refuses every condition inside the item; those on the whole item are copied to what is generated.
pub fn refuse(source: &Source, report: &mut Report) {
    let mut conditions = Conditions { report };
    match source {
        Source::Block(block) => {
            block.item.items.iter().for_each(|item| conditions.visit_impl_item(item));
        }
        Source::Function(function) => {
            conditions.visit_signature(&function.item.sig);
            conditions.visit_block(&function.item.block);
        }
    }
}

struct Conditions<'r> {
    report: &'r mut Report,
}

impl<'ast> Visit<'ast> for Conditions<'_> {
    fn visit_attribute(&mut self, attribute: &'ast Attribute) {
        if ["cfg", "cfg_attr"].iter().any(|word| attribute.path().is_ident(word)) {
            let word = attribute.path().segments[0].ident.to_string();
            self.report.at(attribute, Mistake::Condition(word));
        }
        visit::visit_attribute(self, attribute);
    }
}
