//! The modules of a crate, and who uses whom among the children of each.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, Result};
use syn::Item;

use super::super::paths::{self, Segments, Written};

/// For each name of a module: the names of those that it uses, each with the files and paths that say so.
/// Paths come first that begin at the root or at `super`; others go through what these import.
pub type Uses = BTreeMap<String, BTreeMap<String, BTreeSet<(bool, String)>>>;

/// Globs that import through each other, at most.
const MOST_GLOBS: usize = 4;

/// No path is longer: `use other::other` of another crate would be put in for its own first name for ever.
const LONGEST: usize = 24;

/// A crate's modules, but for those of its tests.
pub struct Tree<'f> {
    /// Paths from the root's folder, and texts.
    files: &'f BTreeMap<String, String>,
    /// Names of the root.
    roots: Vec<String>,
    pub modules: BTreeSet<Segments>,
    /// Paths from the root by modules and the names that they import, or define: a function and a module may
    /// share one.
    shown: BTreeMap<(Segments, String), BTreeSet<Segments>>,
    /// Modules from which modules import every name.
    globs: BTreeMap<Segments, Vec<Segments>>,
    /// Paths that the files name, each with its file.
    written: Vec<(String, Written)>,
}

impl<'f> Tree<'f> {
    /// Of the root's file, and of those that it declares, directly or through others.
    pub fn of(root: &str, files: &'f BTreeMap<String, String>) -> Result<Self> {
        let mut tree = Self {
            files,
            roots: vec!["crate".into()],
            modules: BTreeSet::new(),
            shown: BTreeMap::new(),
            globs: BTreeMap::new(),
            written: Vec::new(),
        };
        tree.read(root, &[])?;
        Ok(tree)
    }

    fn read(&mut self, path: &str, module: &[String]) -> Result<()> {
        let file = syn::parse_file(&self.files[path]).with_context(|| path.to_owned())?;
        self.declare(module, &file.items)?;
        let written = paths::of_file(module.to_vec(), &file);
        self.written.extend(written.into_iter().map(|written| (path.to_owned(), written)));
        Ok(())
    }

    fn declare(&mut self, module: &[String], items: &[Item]) -> Result<()> {
        self.modules.insert(module.to_vec());
        for item in items {
            let (attributes, name) = paths::head(item);
            if paths::is_for_tests(attributes) {
                continue;
            }
            let own = name.map(|name| [module, &[name.to_string()]].concat());
            match (item, own) {
                (Item::Mod(syn::ItemMod { content: Some((_, items)), .. }), Some(child)) => {
                    self.declare(&child, items)?
                }
                (Item::Mod(_), Some(child)) => {
                    let path = child.join("/");
                    let paths = [format!("{path}.rs"), format!("{path}/mod.rs")];
                    // A file of another crate, by `#[path]`, is read there.
                    match paths.iter().find(|path| self.files.contains_key(*path)) {
                        Some(path) => self.read(path, &child)?,
                        None => drop(self.modules.insert(child)),
                    }
                }
                (Item::Use(item), _) => {
                    for (segments, name) in paths::of_use(&item.tree) {
                        let mut target = self.absolute(&Written { module: module.to_vec(), segments });
                        if name == "*" {
                            target.pop();
                            self.globs.entry(module.to_vec()).or_default().push(target);
                        } else {
                            self.show(module, name, target);
                        }
                    }
                }
                (Item::ExternCrate(item), _) if item.ident == "self" => {
                    self.roots.extend(item.rename.iter().map(|(_, name)| name.to_string()));
                }
                (_, Some(own)) => {
                    let name = own.last().unwrap().clone();
                    if attributes.iter().any(|attribute| attribute.path().is_ident("macro_export")) {
                        self.show(&[], name.clone(), own.clone());
                    }
                    self.show(module, name, own);
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn show(&mut self, module: &[String], name: String, target: Segments) {
        self.shown.entry((module.to_vec(), name)).or_default().insert(target);
    }

    /// The path from the root. One that begins elsewhere is taken for the module's own: of another crate, it
    /// leads nowhere.
    fn absolute(&self, written: &Written) -> Segments {
        written.in_crate(&self.roots).unwrap_or_else(|| {
            let is_self = written.segments[0] == "self";
            [&written.module[..], &written.segments[usize::from(is_self)..]].concat()
        })
    }

    /// The paths that `path` stands for, where its first name that is no module is an imported one.
    fn next(&self, path: &[String]) -> Vec<Segments> {
        let is_module = |depth: &usize| self.modules.contains(&path[..*depth]);
        let depth = (0..=path.len()).rev().find(is_module).expect("the root");
        let (module, rest) = path.split_at(depth);
        let Some(name) = rest.first() else { return Vec::new() };
        if let Some(targets) = self.shown.get(&(module.to_vec(), name.clone())) {
            return targets.iter().map(|target| [target, &rest[1..]].concat()).collect();
        }
        let globs = self.globs.get(module).into_iter().flatten();
        globs.filter(|glob| self.knows(glob, rest, MOST_GLOBS)).map(|glob| [glob, rest].concat()).collect()
    }

    /// Whether the module has the first name of `rest`, by as many globs as `left` at most. A module is a
    /// name only in front of others: a word alone that is not imported is a variable.
    fn knows(&self, module: &[String], rest: &[String], left: usize) -> bool {
        let is_module = || rest.len() > 1 && self.modules.contains(&[module, &rest[..1]].concat());
        let by_globs = |globs: &Vec<Segments>| globs.iter().any(|glob| self.knows(glob, rest, left - 1));
        self.shown.contains_key(&(module.to_vec(), rest[0].clone()))
            || is_module()
            || (left > 0 && self.globs.get(module).is_some_and(by_globs))
    }

    /// The uses among the children of each module.
    pub fn uses(&self) -> BTreeMap<Segments, Uses> {
        let mut uses = BTreeMap::<Segments, Uses>::new();
        for (file, written) in &self.written {
            let mut left = vec![self.absolute(written)];
            let mut seen = BTreeSet::new();
            while let Some(path) = left.pop() {
                if path.len() > LONGEST || !seen.insert(path.clone()) {
                    continue;
                }
                left.extend(self.next(&path));
                let common = path.iter().zip(&written.module).take_while(|(a, b)| a == b).count();
                if let Some(from) = written.module.get(common)
                    && self.modules.contains(&path[..path.len().min(common + 1)])
                    && let Some(to) = path.get(common)
                {
                    let of_parent = uses.entry(path[..common].to_vec()).or_default();
                    let said = of_parent.entry(from.clone()).or_default().entry(to.clone()).or_default();
                    let is_relative = written.in_crate(&self.roots).is_none();
                    said.insert((is_relative, format!("{file}: {}", written.segments.join("::"))));
                }
            }
        }
        uses
    }
}
