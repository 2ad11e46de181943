//! Paths that a source file names, as it writes them, but for those of its tests.

use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, Item};

/// A path: its segments.
pub type Segments = Vec<String>;

/// A path as a file writes it.
pub struct Written {
    /// The module in which it stands, from the crate's root.
    pub module: Segments,
    pub segments: Segments,
}

impl Written {
    /// The path from the crate's root, which `roots` name, where it begins there or at `super`. One that ends
    /// at once names nothing.
    pub fn in_crate(&self, roots: &[impl AsRef<str>]) -> Option<Segments> {
        let is_root = |segment: &String| roots.iter().any(|root| root.as_ref() == segment);
        if self.segments.iter().all(|segment| segment == "super" || is_root(segment)) {
            return None;
        }
        let up = self.segments.iter().take_while(|segment| *segment == "super").count();
        let depth = match &self.segments[0] {
            first if is_root(first) => return Some(self.segments[1..].to_vec()),
            _ if up > 0 => self.module.len().checked_sub(up)?,
            _ => return None,
        };
        Some([&self.module[..depth], &self.segments[up..]].concat())
    }
}

/// Every path of the file of `module`.
pub fn of_file(module: Segments, file: &syn::File) -> Vec<Written> {
    let mut paths = Paths { module, found: Vec::new() };
    paths.visit_file(file);
    paths.found
}

/// The paths of a `use`, each with the name that it has from there on: `*` for all that it shows.
pub fn of_use(tree: &syn::UseTree) -> Vec<(Segments, String)> {
    fn add(before: &[String], tree: &syn::UseTree, found: &mut Vec<(Segments, String)>) {
        let mut add_one = |name: &Ident, shown: &Ident| {
            if name != "self" {
                found.push(([before, &[name.to_string()]].concat(), shown.to_string()));
            } else if let Some(last) = before.last() {
                let shown = if shown == "self" { last.clone() } else { shown.to_string() };
                found.push((before.to_vec(), shown));
            }
        };
        match tree {
            syn::UseTree::Path(path) => add(&[before, &[path.ident.to_string()]].concat(), &path.tree, found),
            syn::UseTree::Name(name) => add_one(&name.ident, &name.ident),
            syn::UseTree::Rename(rename) => add_one(&rename.ident, &rename.rename),
            syn::UseTree::Glob(_) => found.push(([before, &["*".into()]].concat(), "*".into())),
            syn::UseTree::Group(group) => group.items.iter().for_each(|tree| add(before, tree, found)),
        }
    }
    let mut found = Vec::new();
    add(&[], tree, &mut found);
    found
}

/// The attributes of an item, and its name if it has one.
pub fn head(item: &Item) -> (&[Attribute], Option<&Ident>) {
    match item {
        Item::Const(item) => (&item.attrs, Some(&item.ident)),
        Item::Enum(item) => (&item.attrs, Some(&item.ident)),
        Item::ExternCrate(item) => (&item.attrs, Some(&item.ident)),
        Item::Fn(item) => (&item.attrs, Some(&item.sig.ident)),
        Item::Impl(item) => (&item.attrs, None),
        Item::Macro(item) => (&item.attrs, item.ident.as_ref()),
        Item::Mod(item) => (&item.attrs, Some(&item.ident)),
        Item::Static(item) => (&item.attrs, Some(&item.ident)),
        Item::Struct(item) => (&item.attrs, Some(&item.ident)),
        Item::Trait(item) => (&item.attrs, Some(&item.ident)),
        Item::Type(item) => (&item.attrs, Some(&item.ident)),
        Item::Use(item) => (&item.attrs, None),
        _ => (&[], None),
    }
}

/// Whether it stands under `#[cfg(test)]`.
pub fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute.parse_args::<syn::Ident>().is_ok_and(|flag| flag == "test")
    })
}

struct Paths {
    /// The module that is looked at, from the crate's root.
    module: Segments,
    found: Vec<Written>,
}

impl Paths {
    fn add(&mut self, segments: Segments) {
        self.found.push(Written { module: self.module.clone(), segments });
    }

    /// The paths in what a macro is given, or consists of, each behind `before`. A word alone may be
    /// anything.
    fn add_tokens(&mut self, before: &[String], tokens: TokenStream) {
        let mut written = before.to_vec();
        let mut colons = 0;
        let end = |written: &mut Segments, paths: &mut Self| {
            let path = std::mem::replace(written, before.to_vec());
            if path.len() > 1.max(before.len()) {
                paths.add(path);
            }
        };
        for token in tokens {
            match token {
                TokenTree::Ident(ident) => {
                    if colons != 2 {
                        end(&mut written, self);
                    }
                    written.push(ident.to_string());
                    colons = 0;
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
                TokenTree::Group(group) if colons == 2 && group.delimiter() == Delimiter::Brace => {
                    self.add_tokens(&written, group.stream());
                    (written, colons) = (before.to_vec(), 0);
                }
                other => {
                    end(&mut written, self);
                    colons = 0;
                    if let TokenTree::Group(group) = other {
                        self.add_tokens(&[], group.stream());
                    }
                }
            }
        }
        end(&mut written, self);
    }
}

impl<'ast> Visit<'ast> for Paths {
    fn visit_item(&mut self, item: &'ast Item) {
        if !is_for_tests(head(item).0) {
            visit::visit_item(self, item);
        }
    }

    fn visit_local(&mut self, local: &'ast syn::Local) {
        if !is_for_tests(&local.attrs) {
            visit::visit_local(self, local);
        }
    }

    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        self.module.push(module.ident.to_string());
        visit::visit_item_mod(self, module);
        self.module.pop();
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        of_use(&item.tree).into_iter().for_each(|(path, _)| self.add(path));
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.add(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, invocation: &'ast syn::Macro) {
        self.visit_path(&invocation.path);
        self.add_tokens(&[], invocation.tokens.clone());
    }
}
