//! The crate's root holds what a user types, and no more; nothing is public that nobody names.

use std::collections::{BTreeMap, BTreeSet, HashSet};

use anyhow::{Context, Result, bail, ensure};
use syn::{Item, UseTree, Visibility};
use xshell::Shell;

use super::kept;
use crate::project;

/// Most public names in the root.
const MOST: usize = 40;

/// The names that `source` shows: public imports, modules and items.
fn shown(source: &str) -> Result<BTreeSet<String>> {
    let mut names = BTreeSet::new();
    for item in syn::parse_file(source)?.items {
        let (visibility, name) = match &item {
            Item::Use(item) => {
                if matches!(item.vis, Visibility::Public(_)) {
                    leaves(&item.tree, &mut names)?;
                }
                continue;
            }
            Item::Const(item) => (&item.vis, &item.ident),
            Item::Enum(item) => (&item.vis, &item.ident),
            Item::Fn(item) => (&item.vis, &item.sig.ident),
            Item::Mod(item) => (&item.vis, &item.ident),
            Item::Static(item) => (&item.vis, &item.ident),
            Item::Struct(item) => (&item.vis, &item.ident),
            Item::Trait(item) => (&item.vis, &item.ident),
            Item::Type(item) => (&item.vis, &item.ident),
            _ => continue,
        };
        if matches!(visibility, Visibility::Public(_)) {
            names.insert(name.to_string());
        }
    }
    Ok(names)
}

fn leaves(tree: &UseTree, names: &mut BTreeSet<String>) -> Result<()> {
    match tree {
        UseTree::Path(path) => leaves(&path.tree, names)?,
        UseTree::Group(group) => group.items.iter().try_for_each(|tree| leaves(tree, names))?,
        UseTree::Name(name) => drop(names.insert(name.ident.to_string())),
        UseTree::Rename(rename) => drop(names.insert(rename.rename.to_string())),
        UseTree::Glob(_) => bail!("a glob hides what is public"),
    }
    Ok(())
}

/// The words of those of the files that stand in one of the folders, and not under a name of `without`.
fn words(files: &[String], folders: &[&str], without: &[&str]) -> Result<BTreeSet<String>> {
    let mut texts = Vec::new();
    for path in files {
        let is_in = |folder: &&str| {
            path.strip_prefix(*folder).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        if folders.iter().any(is_in) && !path.split('/').any(|part| without.contains(&part)) {
            texts.push(project::text(path)?);
        }
    }
    let words = kept::of(&format!("words of {}", folders.join("-")), &texts, || {
        let words = texts.iter().flat_map(|text| text.split(|c: char| !c.is_alphanumeric() && c != '_'));
        Ok(words.collect::<HashSet<_>>().into_iter().map(str::to_owned).collect())
    });
    Ok(words?.into_iter().collect())
}

fn missing(names: &BTreeSet<String>, words: &BTreeSet<String>) -> Vec<String> {
    names.difference(words).cloned().collect()
}

/// Names in the root above the most, public names that nobody names, and names that two types share.
pub fn check(shell: &Shell) -> Result<Vec<String>> {
    let names = shown(&project::text("runtime/src/lib.rs")?)?;
    // A macro, a module, an import of one name, one of a list.
    let seen = ["rayleigh_system", "system", "nalgebra", "Trajectory"];
    ensure!(seen.iter().all(|name| names.contains(*name)), "names of the root were not seen");
    let mut found = Vec::new();
    if names.len() > MOST {
        found.push(format!("runtime/src/lib.rs: {} public names, and {MOST} may be: {names:?}", names.len()));
    }
    let sources = project::sources(project::root(), &project::root().join("runtime/src"))?;
    found.extend(unnamed(shell, &sources)?);
    found.extend(shared(&sources)?);
    Ok(found)
}

/// Names that floors and topics show, and no example, page, test or macro names; of `generated`, no macro; of
/// what types have, no binding either.
fn unnamed(shell: &Shell, sources: &[(String, String)]) -> Result<Vec<String>> {
    let mut files = project::files(shell, ".rs")?;
    let of_macros = words(&files, &["macros/src"], &["tests"])?;
    files.extend(project::files(shell, ".md")?);
    files.extend(project::files(shell, ".stderr")?);
    let places = [
        "README.md",
        "bindings/face",
        "docs",
        "examples",
        "firmware",
        "macros",
        "measure",
        "runtime/src/guide",
        "tests",
    ];
    let of_users = words(&files, &places, &["snapshots"])?;
    let floors = ["system.rs", "step.rs", "rules.rs", "run.rs", "derivative.rs", "run/tolerance.rs"];
    let mut found = Vec::new();
    for (file, words) in
        floors.map(|file| (file, &of_users)).into_iter().chain([("generated.rs", &of_macros)])
    {
        let names = shown(&project::text(format!("runtime/src/{file}"))?).context(file)?;
        found.extend(
            missing(&names, words).iter().map(|name| format!("runtime/src/{file}: nobody names {name}")),
        );
    }
    // A binding has types of the same names.
    let of_bindings = words(&files, &["bindings"], &[])?;
    let is_named = |name: &String| of_users.contains(name) || of_bindings.contains(name);
    for (path, text) in sources {
        found.extend(
            members(text).filter(|name| !is_named(name)).map(|name| format!("{path}: nobody names {name}")),
        );
    }
    Ok(found)
}

/// The types that a source declares for all.
fn types(source: &str) -> impl Iterator<Item = String> {
    declared(source, "pub ", &["struct ", "enum ", "trait ", "type "])
}

/// The functions and constants of types that a source declares for all.
fn members(source: &str) -> impl Iterator<Item = String> {
    declared(source, "    pub ", &["fn ", "const fn ", "const "])
}

/// The names behind one of these kinds, on lines that begin so.
fn declared(source: &str, begin: &str, kinds: &[&str]) -> impl Iterator<Item = String> {
    source.lines().filter_map(move |line| {
        let rest = line.strip_prefix(begin)?;
        let kind = kinds.iter().find(|kind| rest.starts_with(**kind))?;
        Some(rest[kind.len()..].split(|c: char| !c.is_alphanumeric() && c != '_').next()?.to_owned())
    })
}

/// Names that are more than one thing, in whatever modules.
fn shared(files: &[(String, String)]) -> Result<Vec<String>> {
    let mut declared = BTreeMap::<_, Vec<&str>>::new();
    for (path, text) in files {
        types(text).for_each(|name| declared.entry(name).or_default().push(path));
    }
    ensure!(
        declared.contains_key("ExactSegment") && declared.contains_key("Trajectory"),
        "types were not seen"
    );
    declared.retain(|_, places| places.len() > 1);
    Ok(declared.iter().map(|(name, places)| format!("two types are {name}: {}", places.join(", "))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_holds_what_a_user_types() {
        assert_eq!(check(&project::shell().unwrap()).unwrap(), [""; 0]);
    }

    #[test]
    fn every_way_to_show_a_name_is_counted() {
        let source = "pub mod a; mod b; pub use b::{C, d::{E, F as G}}; pub(crate) use b::H; use b::I; pub fn j() {} \
                      pub struct K; pub trait L {} pub enum M {} pub const N: f64 = 0.0; pub type O = f64; fn p() {} \
                      #[cfg(feature = \"std\")] pub use b::q; pub static R: f64 = 0.0;";
        let names = ["a", "C", "E", "G", "j", "K", "L", "M", "N", "O", "q", "R"].map(String::from);
        assert_eq!(shown(source).unwrap(), BTreeSet::from(names));
    }

    #[test]
    fn a_name_that_nobody_names_is_seen() {
        let names = BTreeSet::from(["Midpoint", "NamedByNobody"].map(String::from));
        let named = BTreeSet::from(["Midpoint", "Trapezoidal"].map(String::from));
        assert_eq!(missing(&names, &named), ["NamedByNobody"]);
    }

    #[test]
    fn a_member_that_nobody_names_is_seen() {
        let source = "impl A {\n    pub const fn named_by_no_one() {}\n    pub fn linearized<T>() {}\n    pub B: f64,\n    \
                      pub(crate) fn c() {}\n    pub const NAMED_BY_NO_ONE: f64 = 0.0;\n    fn d() {}\n}";
        let found = unnamed(&project::shell().unwrap(), &[("a.rs".to_owned(), source.to_owned())]).unwrap();
        let unnamed = ["named_by_no_one", "NAMED_BY_NO_ONE"].map(|name| format!("a.rs: nobody names {name}"));
        assert_eq!(found, unnamed);
    }

    #[test]
    fn types_that_share_a_name_are_seen() {
        let source = "pub struct Segment<T>(T);\npub(crate) enum Inner {}\n    pub type Item = u8;\npub trait Segment {}";
        assert_eq!(types(source).collect::<Vec<_>>(), ["Segment", "Segment"]);
        let files = [("a.rs", source), ("b.rs", "pub struct ExactSegment;\npub struct Trajectory;")];
        let files = files.map(|(path, text)| (path.to_owned(), text.to_owned()));
        assert_eq!(shared(&files).unwrap(), ["two types are Segment: a.rs, a.rs"]);
    }
}
