//! Circles of made-up crates, and of the project.

use super::*;

#[test]
fn modules_use_each_other_in_no_circle() {
    assert_eq!(check(&project::shell().unwrap()).unwrap(), [""; 0]);
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
    let found = circles("a", &Tree::of("lib.rs", &files).unwrap());
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
