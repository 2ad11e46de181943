//! Circles among modules: children of one module that use each other, in any crate, at any depth.
//!
//! A child uses a sibling where a path that is written in it, or below it, goes through their parent to the
//! sibling, or to a name that their parent imports from there. A method called on a value is no path: a
//! circle through methods alone is not seen, nor one through `macro_rules!` in the order of the text.

mod tree;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use anyhow::{Context, Result, ensure};
use xshell::Shell;

use super::{beside, kept};
use crate::project;
use tree::{Tree, Uses};

/// The modules that `from` uses, by itself or through others.
fn reached<'u>(uses: &'u Uses, from: &'u str) -> BTreeSet<&'u str> {
    let mut found = BTreeSet::new();
    let mut left = vec![from];
    while let Some(module) = left.pop() {
        let used = uses.get(module).into_iter().flat_map(BTreeMap::keys).map(String::as_str);
        left.extend(used.filter(|module| found.insert(*module)));
    }
    found
}

/// The circles of a crate, each with the files and paths that make it.
fn circles(name: &str, tree: &Tree) -> BTreeMap<String, String> {
    let mut circles = BTreeMap::new();
    for (parent, uses) in tree.uses() {
        for module in uses.keys() {
            let mut circle = reached(&uses, module);
            circle.retain(|other| reached(&uses, other).contains(module.as_str()));
            if circle.is_empty() {
                continue;
            }
            let mut arrows = String::new();
            for (&from, used) in circle.iter().map(|from| (from, &uses[*from])) {
                for (to, said) in used.iter().filter(|(to, _)| circle.contains(to.as_str())) {
                    let best = said.first().map(|said| said.0);
                    for (_, said) in said.iter().filter(|said| Some(said.0) == best) {
                        writeln!(arrows, "    {from} → {to} ({said})").unwrap();
                    }
                }
            }
            let parent = [&[name.to_owned()], &parent[..]].concat().join("/");
            let modules = circle.into_iter().collect::<Vec<_>>().join(", ");
            circles.insert(format!("{parent}: {{{modules}}}"), arrows);
        }
    }
    circles
}

/// The circles of all crates, with the files and paths that make them.
pub fn check(shell: &Shell) -> Result<Vec<String>> {
    let mut roots = project::files(shell, ".rs")?;
    roots.retain(|path| path.ends_with("/lib.rs") || path.ends_with("/main.rs"));
    let (mut found, mut modules) = (BTreeMap::new(), 0);
    for of_crate in beside::each(roots, |root| of_crate(&root))? {
        let (count, circles) = of_crate.split_first().context("a count of modules")?;
        modules += count.parse::<usize>()?;
        found.extend(circles.chunks_exact(2).map(|pair| (pair[0].clone(), pair[1].clone())));
    }
    ensure!(modules > 700, "{modules} modules alone were looked at");
    Ok(found.iter().map(|(circle, arrows)| format!("to be taken apart: {circle}\n{arrows}")).collect())
}

/// The number of modules of a crate, given by its root's file, and in turn its circles and what makes them.
fn of_crate(root: &str) -> Result<Vec<String>> {
    let (name, file) = root.rsplit_once('/').context("a file in a folder")?;
    let folder = project::root().join(name);
    let files = project::sources(&folder, &folder)?.into_iter().collect();
    kept::of(&format!("circles of {root}"), &files, || {
        let tree = Tree::of(file, &files)?;
        let circles = circles(name.trim_end_matches("/src"), &tree).into_iter().flat_map(<[_; 2]>::from);
        Ok([tree.modules.len().to_string()].into_iter().chain(circles).collect())
    })
}

#[cfg(test)]
mod tests;
