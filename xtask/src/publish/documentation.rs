//! The packages compiled by the oldest compiler, and documented as docs.rs does.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use serde_json::Value;
use xshell::cmd;

use super::{PUBLISHED, Publication, packages_of, step, text};

/// Compiles the packages, with all features and with none.
pub fn check_build(of: &mut Publication, packages: &Path, least: &str) -> Result<()> {
    step(&format!("the packages, compiled by Rust {least}, with all features and with none"));
    let shell = of.shell.clone();
    let toolchain = format!("+{least}");
    let tool = cmd!(shell, "cargo {toolchain} --version");
    let has = of.has(tool, cmd!(shell, "rustup toolchain install --profile minimal {least}"));
    let toolchain = has.then_some(&toolchain);
    shell.change_dir(packages);
    let cargo = || cmd!(shell, "cargo").args(toolchain);
    of.succeeds(cargo().args(["check", "--offline", "--workspace", "--all-features"]));
    of.succeeds(cargo().args(["check", "--offline", "--package", "dalembert-c", "--no-default-features"]));
    Ok(())
}

/// Sees that what docs.rs will show has no links into nothing, be they rustdoc's or written as addresses.
pub fn check(of: &mut Publication, packages: &Path) -> Result<()> {
    step("documentation of the packages, as docs.rs makes it");
    let documentation = of.target.join("doc");
    let shell = of.shell.clone();
    shell.remove_path(&documentation)?;
    let metadata = of.metadata(packages, &["--no-deps", "--offline", "--locked"])?;
    let features = packages_of(&metadata).iter().flat_map(features).collect::<Vec<_>>().join(",");
    shell.change_dir(packages);
    let doc = cmd!(shell, "cargo doc --offline --no-deps --workspace --features {features}");
    of.succeeds(doc.env("RUSTDOCFLAGS", "-D warnings --cfg docsrs"));
    for name in PUBLISHED {
        let mut dead = BTreeMap::new();
        let folder = documentation.join(name.replace('-', "_"));
        dead_links(&folder, &mut dead).with_context(|| format!("documentation of {name}"))?;
        for (address, page) in dead {
            let page = page.strip_prefix(&documentation).unwrap_or(&page).display().to_string();
            of.fail(name, format!("{page} leads to {address}, which is not there"));
        }
    }
    Ok(())
}

/// The features of a package that docs.rs is told to use.
fn features(package: &Value) -> Vec<String> {
    let asked = &package["metadata"]["docs"]["rs"];
    let chosen: Vec<_> = if asked["all-features"] == true {
        package["features"].as_object().into_iter().flat_map(|features| features.keys().cloned()).collect()
    } else {
        let listed = asked["features"].as_array().into_iter().flatten();
        listed.filter_map(Value::as_str).map(str::to_owned).collect()
    };
    chosen.iter().map(|feature| format!("{}/{feature}", text(package, "name"))).collect()
}

/// Addresses on the pages below a folder that lead nowhere, each with a page that has it.
fn dead_links(folder: &Path, dead: &mut BTreeMap<String, PathBuf>) -> Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            dead_links(&path, dead)?;
        } else if path.extension().is_some_and(|extension| extension == "html") {
            let page = fs::read_to_string(&path)?;
            let is_dead = |address: &str| !leads_somewhere(folder, address);
            for address in addresses(&page).filter(|address| is_dead(address)) {
                dead.insert(address.to_owned(), path.clone());
            }
        }
    }
    Ok(())
}

/// The addresses on a page, without anchors and queries.
fn addresses(page: &str) -> impl Iterator<Item = &str> {
    let behind = ["href=\"", "src=\""].into_iter().flat_map(|key| page.split(key).skip(1));
    behind.filter_map(|rest| rest.split(['"', '#', '?']).next()).filter(|address| !address.is_empty())
}

fn leads_somewhere(folder: &Path, address: &str) -> bool {
    let is_of_rustdoc =
        ["static.files/", "trait.impl/", "type.impl/"].iter().any(|part| address.contains(part));
    let is_elsewhere = ["https:", "http:", "data:"].iter().any(|scheme| address.starts_with(scheme));
    is_of_rustdoc || is_elsewhere || folder.join(decoded(address)).exists()
}

/// An address without `%` and two digits for a byte.
fn decoded(address: &str) -> String {
    let mut parts = address.split('%');
    let mut bytes = parts.next().unwrap_or_default().as_bytes().to_vec();
    for part in parts {
        match part.get(..2).and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                bytes.extend_from_slice(&part.as_bytes()[2..]);
            }
            None => bytes.extend_from_slice(format!("%{part}").as_bytes()),
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use serde_json::json;
    use xshell::Shell;

    use super::*;

    #[test]
    fn dead_addresses_are_seen() {
        let folder = Shell::new().unwrap().create_temp_dir().unwrap();
        let folder = folder.path();
        fs::create_dir(folder.join("a")).unwrap();
        fs::write(folder.join("x y.html"), "").unwrap();
        let page =
            "<a href=\"../x%20y.html#z\"><a href=\"#here\"><a href=\"https://a.org\"><img src=\"none.svg\">";
        fs::write(folder.join("a/page.html"), page).unwrap();
        let mut dead = BTreeMap::new();
        dead_links(folder, &mut dead).unwrap();
        assert_eq!(dead, BTreeMap::from([("none.svg".to_owned(), folder.join("a/page.html"))]));
    }

    #[test]
    fn features_are_those_that_docs_rs_is_told() {
        let of = |rs| {
            features(&json!({"name": "n", "features": {"a": [], "b": []}, "metadata": {"docs": {"rs": rs}}}))
        };
        assert_eq!(of(json!({"all-features": true})), ["n/a", "n/b"]);
        assert_eq!(of(json!({"features": ["b"]})), ["n/b"]);
    }
}
