//! `docs/corrections.md` and `docs/theory.md` name tests; each of them exists.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Files of this folder and its folders by name, and the names of all functions in them.
fn tests() -> (BTreeSet<String>, BTreeSet<String>) {
    let (mut files, mut functions) = (BTreeSet::new(), BTreeSet::new());
    let mut paths = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("tests")];
    while let Some(path) = paths.pop() {
        if path.is_dir() {
            paths.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.insert(path.file_stem().unwrap().to_str().unwrap().to_owned());
            let names = fs::read_to_string(path).unwrap();
            let names =
                names.lines().filter_map(|line| line.trim_start().strip_prefix("fn ")?.split('(').next());
            functions.extend(names.map(str::to_owned));
        }
    }
    (files, functions)
}

/// The names in `page` that are neither a file nor a function among the tests: what stands between
/// back-quotes and reads like a sentence of four words or more, or is a part of a path.
fn missing(page: &str) -> Vec<String> {
    let (files, functions) = tests();
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

#[test]
fn every_test_that_the_pages_name_exists() {
    for (page, names) in [("corrections.md", 30), ("theory.md", 10)] {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs").join(page);
        let page = fs::read_to_string(page).unwrap();
        assert!(page.matches("::").count() > names, "the page names its tests");
        let missing: Vec<_> =
            missing(&page).into_iter().filter(|name| !LABELS.contains(&name.as_str())).collect();
        assert_eq!(missing, Vec::<String>::new());
    }
}

#[test]
fn a_name_that_does_not_exist_is_seen() {
    assert_eq!(missing("Test: `the_moon_is_a_cheese`."), ["the_moon_is_a_cheese"]);
    assert_eq!(missing("`project::cheese`"), ["project", "cheese"]);
    assert!(
        missing("Test: `tests/tests/project/corrections_page.rs`: `a_name_that_does_not_exist_is_seen`.")
            .is_empty()
    );
}

/// Labels of the paper's LaTeX source that look like names of tests.
const LABELS: &[&str] = &["definitions_gamma_plus_minus"];
