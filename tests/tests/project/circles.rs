//! Circles among modules: children of one module that use each other, in any crate, at any depth.
//!
//! A child uses a sibling where a path that is written in it, or below it, goes through their parent to the
//! sibling, or to a name that their parent imports from there. A method called on a value is no path: a
//! circle through methods alone is not seen, nor one through `macro_rules!` in the order of the text.
//!
//! `cargo test -p dalembert-tests --test project circles -- --nocapture` prints the files and paths of each.

mod tree;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use super::paths::read;
use tree::{Tree, Uses};

/// Circles that stand today: modules each of which uses every other, by itself or through others. The list
/// only ever gets shorter: a new circle is taken apart, not entered here, and one that is gone is struck out.
const KNOWN: &[&str] = &[
    "c: {boundary, machine, parameters}",
    "fmu: {cosimulation, derivatives, saved}",
    "macros/rayleigh_system/lower: {integer, value}",
    "macros/rayleigh_system/written_out: {in_lanes, stages}",
    "python/binding: {checks, events, motion, offer, record, system}",
    "python/binding: {class, ensemble}",
    "python/binding: {many, model}",
    "python/binding: {module, stub}",
    "report: {figures, page}",
    "report: {ours, scenes}",
    "runtime/numbers/dual: {derivatives, singular}",
    "runtime/numbers/dual: {lift, real}",
    "runtime/numbers/linear: {banded, dense, of_members}",
    "runtime/rules/gauss/in_lanes: {allowances, floors, sweeps}",
    "runtime/run/tolerance: {guard, request}",
    "tests/examples/random_programs: {batch, lowered, members, trial, verdict}",
];

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

/// The files of crates' roots under `folder`.
fn roots(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            roots(&path, found);
        } else if ["lib.rs", "main.rs"].contains(&name.as_str()) {
            found.push(path);
        }
    }
}

#[test]
fn modules_use_each_other_in_no_new_circle() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let (mut crates, mut found, mut modules) = (Vec::new(), BTreeMap::new(), 0);
    roots(&project, &mut crates);
    for root in crates {
        let folder = root.parent().unwrap();
        let mut files = Vec::new();
        read(folder, folder, &mut files);
        let files = files.into_iter().collect();
        let tree = Tree::of(root.file_name().unwrap().to_str().unwrap(), &files);
        modules += tree.modules.len();
        let name = folder.strip_prefix(&project).unwrap().to_str().unwrap().replace('\\', "/");
        found.extend(circles(name.trim_end_matches("/src"), &tree));
    }
    found.iter().for_each(|(circle, arrows)| println!("{circle}\n{arrows}"));
    // Not for want of looking.
    assert!(modules > 700, "{modules} modules");
    let gone: Vec<_> = KNOWN.iter().filter(|circle| !found.contains_key(**circle)).collect();
    found.retain(|circle, _| !KNOWN.contains(&circle.as_str()));
    let new: String = found.iter().map(|(circle, arrows)| format!("{circle}\n{arrows}")).collect();
    assert!(new.is_empty() && gone.is_empty(), "new circles:\n{new}gone, to be struck out: {gone:#?}");
}

/// The circles of a made-up crate `a`: its root, and its module `deep` with two children. Roots and parents
/// are given without the declarations of their children.
fn of_files(root: &str, deep: &str, one: &str, two: &str) -> Vec<String> {
    let files = [
        ("lib.rs", format!("mod deep; {root}")),
        ("deep.rs", format!("mod one; mod two; {deep}")),
        ("deep/one.rs", one.to_owned()),
        ("deep/two.rs", format!("mod below; {two}")),
        ("deep/two/below.rs", "pub struct Below(super::super::one::One);".to_owned()),
    ];
    let files = files.map(|(path, text)| (path.to_owned(), text)).into();
    let found = circles("a", &Tree::of("lib.rs", &files));
    found.into_iter().map(|(circle, arrows)| format!("{circle}\n{arrows}")).collect()
}

#[test]
fn every_way_to_use_a_sibling_is_seen() {
    let there = "    two → one (deep/two/below.rs: super::super::one::One)\n";
    let of_one = |deep, one, said: &str| {
        let circle = format!("a/deep: {{one, two}}\n    one → two (deep/one.rs: {said})\n{there}");
        assert_eq!(of_files("", deep, one, "pub struct Two;"), [circle], "{one}");
    };
    of_one("", "pub struct One(super::two::Two);", "super::two::Two");
    of_one("", "pub struct One(crate::deep::two::Two);", "crate::deep::two::Two");
    of_one("pub use two::Two;", "pub struct One(super::Two);", "super::Two");
    of_one("pub use two::Two as Other;", "use crate::{deep::Other};", "crate::deep::Other");
    let by_feature = "#[cfg(a)] pub use two::Two; #[cfg(not(a))] pub struct Two;";
    of_one(by_feature, "pub struct One(super::Two);", "super::Two");
    of_one("use two::Two;", "use super::*; pub struct One(Two);", "Two");
    of_one("", "use super::*; pub struct One(two::Two);", "two::Two");
    of_one("", "use crate::deep; pub struct One(deep::two::Two);", "deep::two::Two");
    of_one("", "mod inner { use super::super::two::Two; }", "super::super::two::Two");
    of_one("", "fn f() { g!(of: super::two::Two::new()) }", "super::two::Two::new");
    of_one("", "macro_rules! f { () => { use $crate::deep::{two::Two}; } }", "crate::deep::two::Two");

    // Through the root: what it shows, its own name, and a macro that it has from below.
    let of_root = |root, one, two| of_files(root, "", one, two).len();
    assert_eq!(of_root("pub use deep::two::Two;", "use crate::Two;", ""), 1);
    assert_eq!(of_root("extern crate self as a;", "use a::deep::two::Two;", ""), 1);
    assert_eq!(of_root("", "crate::made!();", "#[macro_export] macro_rules! made { () => {} }"), 1);
    // A level higher, beside the root's own items.
    let flat = "mod flat { use crate::deep::Deep; }";
    let said = ["deep → flat (deep.rs: crate::flat)", "flat → deep (lib.rs: crate::deep::Deep)"];
    let circle = format!("a: {{deep, flat}}\n    {}\n", said.join("\n    "));
    assert_eq!(of_files(flat, "use crate::flat; pub struct Deep;", "", ""), [circle]);
}

#[test]
fn parents_and_tests_make_no_circle() {
    let none = |deep, one| assert_eq!(of_files("", deep, one, "pub struct Two;"), [""; 0], "{one}");
    none("pub struct Own(two::Two);", "pub struct One(super::Own, crate::deep::Own);");
    none("pub struct Own; use two::Two;", "use super::*; pub struct One(Own);");
    none("use two::Two;", "use super::*; struct Two; pub struct One(Two);");
    none("", "use super::*; fn f(two: f64) -> f64 { two }");
    none("", "#[cfg(test)] mod tests { use super::super::two::Two; }");
    none("", "#[cfg(test)] use super::two::Two; #[cfg(test)] fn f(_: super::two::Two) {}");
    none("", "fn f() { #[cfg(test)] let x = super::two::Two; }");
    none("#[cfg(test)] use two::Two;", "use super::Two;");
    none("", "use two::Two; use other::deep::two::Two; use other::other; fn f() { other() }");
}
