//! From tokens to the annotated item.

use proc_macro2::TokenStream;
use syn::{Item, ItemFn, ItemImpl};

use super::diagnostics::{Mistake, Report};
use super::hygiene;
use super::model::{Block, Function, Role, Source};
use super::syntax::simple_name;

/// The annotated block or function, or nothing if it is neither.
pub fn source(item: TokenStream, report: &mut Report) -> Option<Source> {
    match syn::parse2::<Item>(item) {
        Ok(Item::Impl(item)) => Some(Source::Block(Box::new(block(item, report)?))),
        Ok(Item::Fn(item)) => Some(Source::Function(Box::new(function(item, Role::System)))),
        Ok(other) => {
            report.at(&other, Mistake::WrongItem);
            None
        }
        Err(error) => {
            report.error(error);
            None
        }
    }
}

fn block(item: ItemImpl, report: &mut Report) -> Option<Block> {
    if let Some((path, _)) = &item.trait_ {
        report.at(path, Mistake::TraitImpl);
        return None;
    }
    if !item.generics.params.is_empty() {
        report.at(&item.generics, Mistake::GenericBlock);
        return None;
    }
    let Some(name) = simple_name(&item.self_ty).cloned() else {
        report.at(&item.self_ty, Mistake::UnnamedType);
        return None;
    };
    Some(Block { item, name })
}

/// The function of a field, or nothing if the item is no function.
pub fn field(item: TokenStream, report: &mut Report) -> Option<Source> {
    match syn::parse2::<Item>(item) {
        Ok(Item::Fn(item)) => Some(Source::Function(Box::new(function(item, Role::Field)))),
        Ok(other) => {
            report.at(&other, Mistake::WrongField);
            None
        }
        Err(error) => {
            report.error(error);
            None
        }
    }
}

fn function(item: ItemFn, role: Role) -> Function {
    let name = hygiene::marked(hygiene::upper_camel_case(&item.sig.ident));
    Function { item, name, role }
}
