//! The packages: each holds its sources, its page and the licences, whole and nothing else.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Context, Result};
use xshell::cmd;

use super::{PUBLISHED, Publication, of_packages, packages_of, step, text};
use crate::markdown;

/// Of the compressed package, in bytes; crates.io takes ten million.
const LARGEST: u64 = 500_000;

const LICENCES: [&str; 2] = ["LICENSE-MIT", "LICENSE-APACHE"];

const BY_CARGO: [&str; 4] = ["Cargo.toml", "Cargo.toml.orig", "Cargo.lock", ".cargo_vcs_info.json"];

/// Packs what is committed, and makes of the packages a workspace in which each finds the others as crates.io
/// would give them: its folder, if they could be packed.
pub fn check(of: &mut Publication) -> Result<Option<PathBuf>> {
    step("packages");
    let (shell, clone) = (of.shell.clone(), of.shell.current_dir());
    let folder = of.target.join("packages");
    shell.remove_path(&folder)?;
    shell.remove_path(of.target.join("package"))?;
    let package = cmd!(shell, "cargo package --no-verify --offline --locked").args(of_packages(PUBLISHED));
    if !of.succeeds(package) {
        return Ok(None);
    }
    let metadata = of.metadata(&clone, &["--no-deps", "--locked"])?;
    let packages = packages_of(&metadata).iter();
    let published: Vec<_> = packages.filter(|package| PUBLISHED.contains(&text(package, "name"))).collect();
    let (mut members, mut patches) = (Vec::new(), String::new());
    for package in published {
        let (name, version) = (text(package, "name"), text(package, "version"));
        let member = format!("{name}-{version}");
        unpack(of, &member, name)?;
        patches += &format!("{name} = {{ path = \"{member}\" }}\n");
        members.push(member);
    }
    let head = format!("[workspace]\nresolver = \"3\"\nmembers = {members:?}\n[patch.crates-io]\n");
    fs::write(folder.join("Cargo.toml"), head + &patches)?;
    fs::copy(clone.join("Cargo.lock"), folder.join("Cargo.lock"))?;
    Ok(Some(folder))
}

/// Unpacks a package, and looks at what is in it.
fn unpack(of: &mut Publication, member: &str, name: &str) -> Result<()> {
    let (shell, clone) = (of.shell.clone(), of.shell.current_dir());
    let archive = of.target.join("package").join(format!("{member}.crate"));
    let folder = of.target.join("packages");
    fs::create_dir_all(&folder)?;
    cmd!(shell, "tar -xzf {archive} -C {folder}").quiet().run()?;
    let unpacked = folder.join(member);
    let mut files = Vec::new();
    list(&unpacked, &unpacked, &mut files)?;
    let mut bytes = 0;
    for file in &files {
        let file = fs::File::options().write(true).open(unpacked.join(file))?;
        bytes += file.metadata()?.len();
        // Packages carry one time for all files: by it cargo would take those of another commit for compiled.
        file.set_modified(SystemTime::now())?;
    }
    let page = readme(&fs::read_to_string(unpacked.join("Cargo.toml"))?);
    for what in contents(&files, &page) {
        of.fail(name, what);
    }
    for licence in LICENCES {
        if fs::read(unpacked.join(licence)).ok() != fs::read(clone.join(licence)).ok() {
            of.fail(name, format!("{licence} is missing, or another"));
        }
    }
    let text = fs::read_to_string(unpacked.join(&page)).unwrap_or_default();
    for (line, target) in markdown::links(&text).iter().filter(|(_, target)| !target.starts_with("https://"))
    {
        of.fail(name, format!("{page}:{line} leads to {target}, which is not there on crates.io"));
    }
    let compressed = fs::metadata(&archive)?.len();
    if compressed > LARGEST {
        of.fail(name, format!("{compressed} bytes, above {LARGEST}"));
    }
    let (count, kilo) = (files.len(), bytes / 1000);
    println!("   {name:20} {count:4} files {kilo:6} kB, compressed {:4} kB", compressed / 1000);
    Ok(())
}

/// The page that a package's manifest names.
fn readme(manifest: &str) -> String {
    let name = manifest.lines().find_map(|line| line.strip_prefix("readme = \""));
    name.map_or("README.md", |name| name.trim_end_matches('"')).to_owned()
}

/// The files below a folder, by their paths from `root`.
fn list(root: &Path, folder: &Path, files: &mut Vec<String>) -> Result<()> {
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        if path.is_dir() {
            list(root, &path, files)?;
        } else {
            files.push(path.strip_prefix(root)?.display().to_string());
        }
    }
    Ok(())
}

/// Files that should not be in a package, or are missing.
fn contents(files: &[String], page: &str) -> Vec<String> {
    let mut found = Vec::new();
    for file in files {
        let is_known = [&BY_CARGO[..], &LICENCES, &["README.md", page]].concat().contains(&file.as_str());
        if !is_known && !file.starts_with("src/") {
            found.push(format!("{file} is in the package"));
        }
        if file.starts_with("src/tests") || file.contains("/snapshots/") {
            found.push(format!("{file} is in the package, a test's"));
        }
    }
    if !files.iter().any(|file| file == page) {
        found.push(format!("{page}, its page, is missing"));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_do_not_belong_are_seen() {
        let files = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
        let whole = ["Cargo.toml", "CRATE.md", "LICENSE-MIT", "src/lib.rs"];
        assert_eq!(contents(&files(&whole), "CRATE.md"), [""; 0]);
        for other in ["tests/it.rs", "src/tests.rs", "src/tests/snapshots/a.rs"] {
            assert!(!contents(&files(&[&whole[..], &[other]].concat()), "CRATE.md").is_empty(), "{other}");
        }
        assert_eq!(contents(&files(&["src/lib.rs"]), "README.md"), ["README.md, its page, is missing"]);
    }

    #[test]
    fn the_page_is_the_one_that_the_manifest_names() {
        assert_eq!(readme("[package]\nname = \"a\"\nreadme = \"CRATE.md\"\n"), "CRATE.md");
        assert_eq!(readme("[package]\nname = \"a\"\nreadme = false\n"), "README.md");
    }
}
