//! The crate's root holds what a user types, and no more; nothing is public that nobody names.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use syn::{Item, UseTree, Visibility};

/// Most public names in the root.
const MOST: usize = 40;

/// The names that `source` shows: public imports, modules and items.
fn shown(source: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for item in syn::parse_file(source).expect("a source file").items {
        let (visibility, name) = match &item {
            Item::Use(item) => {
                if matches!(item.vis, Visibility::Public(_)) {
                    leaves(&item.tree, &mut names);
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
    names
}

fn leaves(tree: &UseTree, names: &mut BTreeSet<String>) {
    match tree {
        UseTree::Path(path) => leaves(&path.tree, names),
        UseTree::Group(group) => group.items.iter().for_each(|tree| leaves(tree, names)),
        UseTree::Name(name) => drop(names.insert(name.ident.to_string())),
        UseTree::Rename(rename) => drop(names.insert(rename.rename.to_string())),
        UseTree::Glob(_) => panic!("a glob hides what is public"),
    }
}

/// The words of `path`, or of all files under it that are code, pages or messages, but for those under `without`.
fn words(path: &Path, without: &[&str], words: &mut BTreeSet<String>) {
    if without.iter().any(|without| path.ends_with(without)) {
        return;
    }
    if path.is_dir() {
        for entry in fs::read_dir(path).unwrap() {
            self::words(&entry.unwrap().path(), without, words);
        }
    } else if matches!(
        path.extension().and_then(|extension| extension.to_str()),
        Some("rs" | "md" | "stderr")
    ) {
        let text = fs::read_to_string(path).unwrap();
        words.extend(text.split(|c: char| !c.is_alphanumeric() && c != '_').map(str::to_owned));
    }
}

fn missing(names: &BTreeSet<String>, words: &BTreeSet<String>) -> Vec<String> {
    names.difference(words).cloned().collect()
}

#[test]
fn the_root_holds_at_most_forty_names() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../runtime/src/lib.rs");
    let names = shown(&fs::read_to_string(root).unwrap());
    println!("{} names: {names:?}", names.len());
    assert!(names.len() <= MOST, "{} names: {names:?}", names.len());
    // Not for want of looking: a macro, a module, an import of one name, one of a list.
    for name in ["rayleigh_system", "system", "nalgebra", "Trajectory"] {
        assert!(names.contains(name), "{name}");
    }
}

#[test]
fn every_way_to_show_a_name_is_counted() {
    let source = "pub mod a; mod b; pub use b::{C, d::{E, F as G}}; pub(crate) use b::H; use b::I; pub fn j() {} \
                  pub struct K; pub trait L {} pub enum M {} pub const N: f64 = 0.0; pub type O = f64; fn p() {} \
                  #[cfg(feature = \"std\")] pub use b::q; pub static R: f64 = 0.0;";
    let names = ["a", "C", "E", "G", "j", "K", "L", "M", "N", "O", "q", "R"].map(String::from);
    assert_eq!(shown(source), BTreeSet::from(names));
}

/// Floors and topics show what examples, pages, tests or the macros name, `generated` what the macros name.
#[test]
fn nothing_is_public_that_nobody_names() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut of_users = BTreeSet::new();
    for part in [
        "README.md",
        "benches",
        "docs",
        "examples",
        "firmware",
        "macros",
        "report",
        "runtime/src/guide",
        "tests",
    ] {
        words(&project.join(part), &["target", "snapshots", "root.rs"], &mut of_users);
    }
    let mut of_macros = BTreeSet::new();
    words(&project.join("macros/src"), &["tests"], &mut of_macros);
    let of_file = |file: &str| shown(&fs::read_to_string(project.join("runtime/src").join(file)).unwrap());

    let mut unnamed = BTreeMap::new();
    for file in ["system.rs", "step.rs", "rules.rs", "run.rs", "derivative.rs", "run/tolerance.rs"] {
        unnamed.insert(file, missing(&of_file(file), &of_users));
    }
    unnamed.insert("generated.rs", missing(&of_file("generated.rs"), &of_macros));
    unnamed.retain(|_, names| !names.is_empty());
    assert!(unnamed.is_empty(), "{unnamed:#?}");

    let names = BTreeSet::from(["Midpoint", "NamedByNobody"].map(String::from));
    let named = BTreeSet::from(["Midpoint", "Trapezoidal"].map(String::from));
    assert_eq!(missing(&names, &named), ["NamedByNobody"]);
}

/// The types that a source declares for all.
fn types(source: &str) -> impl Iterator<Item = String> {
    source.lines().filter_map(|line| {
        let rest = line.strip_prefix("pub ")?;
        let kind = ["struct ", "enum ", "trait ", "type "].into_iter().find(|kind| rest.starts_with(kind))?;
        Some(rest[kind.len()..].split(|c: char| !c.is_alphanumeric() && c != '_').next()?.to_owned())
    })
}

/// A name is one thing, in whatever module it stands.
#[test]
fn no_two_types_share_a_name() {
    fn collect(folder: &Path, of: &mut BTreeMap<String, Vec<String>>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                collect(&path, of);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                for name in types(&fs::read_to_string(&path).unwrap()) {
                    of.entry(name).or_default().push(path.display().to_string());
                }
            }
        }
    }
    let mut declared = BTreeMap::new();
    collect(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../runtime/src"), &mut declared);
    println!("{} types", declared.len());
    assert!(declared.contains_key("ExactSegment") && declared.contains_key("Trajectory"));
    declared.retain(|_, places| places.len() > 1);
    assert!(declared.is_empty(), "{declared:#?}");

    let source =
        "pub struct Segment<T>(T);\npub(crate) enum Inner {}\n    pub type Item = u8;\npub trait Segment {}";
    assert_eq!(types(source).collect::<Vec<_>>(), ["Segment", "Segment"]);
}
