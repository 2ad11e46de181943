//! `docs/corrections.md`, `docs/theory.md` and `docs/paper.md` name tests; each of them exists. So does
//! what the last says that computes a statement.

use std::collections::BTreeSet;

use anyhow::{Result, ensure};

use crate::project;

/// Labels of the paper's LaTeX source that look like names of tests.
const LABELS: &[&str] =
    &["definitions_gamma_plus_minus", "eq_constant_motion_subalgebra", "eq_commutative_diagram_flows"];

/// Names of the files of tests, and of all functions in them.
type Tests = (BTreeSet<String>, BTreeSet<String>);

fn tests() -> Result<Tests> {
    let (mut files, mut functions) = (BTreeSet::new(), BTreeSet::new());
    let root = project::root();
    for (path, text) in project::sources(root, &root.join("tests/tests"))? {
        files.extend(path.trim_end_matches(".rs").rsplit('/').next().map(str::to_owned));
        let names = text.lines().filter_map(|line| line.trim_start().strip_prefix("fn ")?.split('(').next());
        functions.extend(names.map(str::to_owned));
    }
    Ok((files, functions))
}

/// The names in `page` that are neither a file nor a function among the tests: what stands between
/// back-quotes and reads like a sentence of four words or more, or is a part of a path.
fn missing(page: &str, (files, functions): &Tests) -> Vec<String> {
    let exists = |name: &str| files.contains(name) || functions.contains(name);
    page.split('`')
        .skip(1)
        .step_by(2)
        .flat_map(|quoted| {
            let path = quoted.contains("::");
            let quoted = quoted.trim_start_matches("tests/tests/").trim_end_matches(".rs");
            let parts = quoted.split("::").flat_map(|part| part.split('/'));
            parts
                .filter(|part| part.chars().all(|letter| letter.is_ascii_lowercase() || letter == '_'))
                .filter(|part| path || part.matches('_').count() >= 3)
                .map(str::to_owned)
                .collect::<Vec<_>>()
        })
        .filter(|name| !exists(name))
        .collect()
}

/// Files of tests that are named by their path and do not exist.
fn missing_files(page: &str) -> Vec<String> {
    let paths = page
        .split('`')
        .skip(1)
        .step_by(2)
        .filter(|quoted| quoted.contains("tests/") && quoted.ends_with(".rs") && !quoted.contains('…'));
    paths.filter(|path| !project::root().join(path).exists()).map(str::to_owned).collect()
}

/// Names of the functions, types, traits and scenes that the library and its scenes define.
fn defined() -> Result<BTreeSet<String>> {
    let root = project::root();
    let mut names = BTreeSet::new();
    for folder in ["runtime/src", "examples/examples"] {
        for (path, text) in project::sources(root, &root.join(folder))? {
            names.extend(path.trim_end_matches(".rs").rsplit('/').next().map(str::to_owned));
            let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
            let definitions =
                words.windows(2).filter(|pair| ["fn", "struct", "trait", "enum"].contains(&pair[0]));
            names.extend(definitions.map(|pair| pair[1].to_owned()));
        }
    }
    Ok(names)
}

/// Names in the third column of the tables of four columns of `page` that are not among `defined`.
fn undefined(page: &str, defined: &BTreeSet<String>) -> Vec<String> {
    let rows = page.lines().filter(|line| line.starts_with("| ") && line.matches(" | ").count() == 3);
    rows.filter_map(|row| row.split(" | ").nth(2))
        .flat_map(|cell| cell.split('`').skip(1).step_by(2))
        .filter(|name| !defined.contains(*name))
        .map(str::to_owned)
        .collect()
}

/// Names of tests on the pages that no test has.
pub fn check() -> Result<Vec<String>> {
    let tests = tests()?;
    let mut found = Vec::new();
    let paper = project::text("docs/paper.md")?;
    found.extend(
        undefined(&paper, &defined()?).iter().map(|name| format!("docs/paper.md: nothing is `{name}`")),
    );
    for (page, names) in [("docs/corrections.md", 30), ("docs/theory.md", 10), ("docs/paper.md", 40)] {
        let text = project::text(page)?;
        ensure!(text.matches("::").count() > names, "{page} no longer names its tests");
        let missing = missing(&text, &tests).into_iter().filter(|name| !LABELS.contains(&name.as_str()));
        found.extend(missing.map(|name| format!("{page}: no test is `{name}`")));
        found.extend(missing_files(&text).iter().map(|path| format!("{page}: no file is `{path}`")));
    }
    Ok(found)
}

#[cfg(test)]
mod controls {
    use super::*;

    #[test]
    fn every_test_that_the_pages_name_exists() {
        assert_eq!(check().unwrap(), [""; 0]);
    }

    #[test]
    fn a_name_that_does_not_exist_is_seen() {
        let missing = |page| missing(page, &tests().unwrap());
        assert_eq!(missing("Test: `the_moon_is_a_cheese`."), ["the_moon_is_a_cheese"]);
        assert_eq!(missing("`compiled::cheese`"), ["cheese"]);
        let there = "`tests/tests/project/compiled.rs`: `a_program_compiles_what_its_system_asks_for`.";
        assert_eq!(missing(there), [""; 0]);
        assert_eq!(
            missing_files("`tests/tests/step/cheese.rs`, `tests/tests/step/rest.rs`"),
            ["tests/tests/step/cheese.rs"]
        );
        let row = "| **Theorem** | as printed | `subalgebra`, `moon` | `noether::subalgebra` |";
        assert_eq!(undefined(row, &defined().unwrap()), ["moon"]);
    }
}
