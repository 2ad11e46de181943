//! Metadata of the crates, and of their dependencies.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use serde_json::Value;
use xshell::cmd;

use super::{PUBLISHED, Publication, packages_of, step, text};

/// Slugs of crates.io that the crates may use: an unknown one is refused there, and nowhere before.
const CATEGORIES: [&str; 6] = ["concurrency", "embedded", "mathematics", "no-std", "science", "simulation"];

/// Sees that the crates that may be published are the six, and what each says of itself.
pub fn check(of: &mut Publication) -> Result<()> {
    step("metadata");
    let clone = of.shell.current_dir();
    let metadata = of.metadata(&clone, &["--no-deps", "--locked"])?;
    let packages: BTreeMap<_, _> =
        packages_of(&metadata).iter().map(|package| (text(package, "name"), package)).collect();
    // Packages inherit what the workspace says, this one too.
    let workspace = *packages.get("xtask").context("the workspace has no xtask")?;
    let (open, six) = (open_to_all(of, &clone)?, BTreeSet::from(PUBLISHED.map(str::to_owned)));
    if open != six {
        let others: Vec<_> = open.symmetric_difference(&six).collect();
        of.fail("publish = false", format!("{others:?}: said where it should not be, or missing"));
    }
    for name in PUBLISHED {
        let package = packages.get(name).context(name)?;
        of_package(package, workspace).iter().for_each(|what| of.fail(name, what));
    }
    let version = text(workspace, "version");
    if !fs::read_to_string(clone.join("CITATION.cff"))?.contains(&format!("version: {version}\n")) {
        of.fail("CITATION.cff", "not the version of the workspace");
    }
    Ok(())
}

/// The packages that may be published, also of the workspaces beside this one.
fn open_to_all(of: &Publication, clone: &Path) -> Result<BTreeSet<String>> {
    let mut open = BTreeSet::new();
    for manifest in cmd!(of.shell, "git ls-files *Cargo.toml").quiet().read()?.lines() {
        let folder = clone.join(manifest).parent().context("a folder")?.to_owned();
        let metadata = of.metadata(&folder, &["--no-deps"])?;
        let packages = packages_of(&metadata).iter().filter(|package| package["publish"].is_null());
        open.extend(packages.map(|package| text(package, "name").to_owned()));
    }
    Ok(open)
}

/// Faults in the metadata of a package.
fn of_package(package: &Value, workspace: &Value) -> Vec<String> {
    let mut found = Vec::new();
    for field in ["version", "license", "rust_version", "edition"] {
        if package[field] != workspace[field] {
            found.push(format!("{field} is not the workspace's"));
        }
    }
    if text(package, "description").is_empty() {
        found.push("no description".to_owned());
    }
    let words = |key: &str| -> Vec<&str> {
        package[key].as_array().into_iter().flatten().filter_map(Value::as_str).collect()
    };
    let (keywords, categories) = (words("keywords"), words("categories"));
    if !(1..=5).contains(&keywords.len()) || !keywords.iter().all(|word| is_keyword(word)) {
        found.push(format!("keywords {keywords:?}"));
    }
    if !(1..=5).contains(&categories.len()) || !categories.iter().all(|slug| CATEGORIES.contains(slug)) {
        found.push(format!("categories {categories:?}"));
    }
    if package["metadata"]["docs"].is_null() {
        found.push("nothing is said to docs.rs".to_owned());
    }
    found
}

/// Whether crates.io takes a keyword.
fn is_keyword(word: &str) -> bool {
    let is_of_it = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "_+-".contains(c);
    word.len() <= 20 && word.starts_with(|c: char| c.is_ascii_lowercase()) && word.chars().all(is_of_it)
}

/// Sees that no dependency asks for a newer compiler than the workspace does, and returns that.
pub fn check_rust_versions(of: &mut Publication) -> Result<String> {
    step("rust-version of the dependencies");
    let clone = of.shell.current_dir();
    let metadata = of.metadata(&clone, &["--all-features", "--locked"])?;
    let packages = packages_of(&metadata);
    let workspace = packages.iter().find(|package| text(package, "name") == "xtask");
    let least = text(workspace.context("the workspace has no xtask")?, "rust_version").to_owned();
    let stating: Vec<_> = packages.iter().filter(|package| package["rust_version"].is_string()).collect();
    for package in &stating {
        let asked = text(package, "rust_version");
        if number(asked) > number(&least) {
            of.fail(text(package, "name"), format!("asks for Rust {asked}"));
        }
    }
    println!("   {} of {} packages state one, none above {least}", stating.len(), packages.len());
    Ok(least)
}

/// The two first numbers of a version.
fn number(version: &str) -> Vec<u32> {
    version.split('.').take(2).filter_map(|part| part.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn metadata_that_crates_io_refuses_is_seen() {
        let package = json!({
            "version": "1.0.0", "license": "MIT", "rust_version": "1.89", "edition": "2024", "description": "of it",
            "keywords": ["mechanics"], "categories": ["science"], "metadata": {"docs": {"rs": {}}},
        });
        assert_eq!(of_package(&package, &package), [""; 0]);
        let but = |key: &str, value: Value| {
            let mut other = package.clone();
            other[key] = value;
            of_package(&other, &package).len()
        };
        let wrong = [
            ("version", json!("1.0.1")),
            ("description", json!(null)),
            ("keywords", json!(["Mechanics"])),
            ("keywords", json!([])),
            ("categories", json!(["physics"])),
            ("metadata", json!(null)),
        ];
        wrong.into_iter().for_each(|(key, value)| assert_eq!(but(key, value), 1, "{key}"));
    }

    #[test]
    fn versions_are_compared_by_numbers() {
        assert!(number("1.100") > number("1.89") && number("1.89.1") == number("1.89.0"));
    }
}
