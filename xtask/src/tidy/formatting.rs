//! Formatting of the Rust code of every workspace, by rustfmt.

use std::path::Path;

use anyhow::{Context, Result};
use xshell::cmd;

use super::{beside, kept};
use crate::{project, tools};

/// Differences, package by package.
pub fn check() -> Result<Vec<String>> {
    let shell = project::shell()?;
    let rustfmt = cmd!(shell, "rustfmt --version").quiet().read()? + &project::text("rustfmt.toml")?;
    let found = beside::each(project::files(&shell, "Cargo.toml")?, |manifest| {
        let Some(package) = package(&project::text(&manifest)?) else { return Ok(Vec::new()) };
        let manifest = project::root().join(manifest);
        let folder = manifest.parent().context("a folder")?;
        let texts = (&rustfmt, project::sources(folder, folder)?);
        kept::of(&format!("formatting of {package}"), texts, || differences(&manifest, &package))
    })?;
    Ok(found.concat())
}

/// The name of the package that a manifest is of, if it is not a workspace alone.
fn package(manifest: &str) -> Option<String> {
    let (_, package) = manifest.split_once("[package]\n")?;
    let name = package.lines().find_map(|line| line.strip_prefix("name = "))?;
    Some(name.trim().trim_matches('"').to_owned())
}

/// Changes that rustfmt would make in a package: without its name, in all members of the workspace.
fn differences(manifest: &Path, package: &str) -> Result<Vec<String>> {
    let shell = project::shell()?;
    let command = cmd!(shell, "cargo fmt --check --manifest-path {manifest} --package {package}");
    let output = command.quiet().ignore_status().output()?;
    Ok(if output.status.success() { Vec::new() } else { vec![tools::said(&output)] })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn code_that_rustfmt_would_change_is_seen() {
        let shell = project::shell().unwrap();
        let folder = shell.create_temp_dir().unwrap();
        let manifest = folder.path().join("Cargo.toml");
        fs::create_dir(folder.path().join("src")).unwrap();
        fs::write(&manifest, "[package]\nname = \"planted\"\nedition = \"2024\"\n").unwrap();
        fs::write(folder.path().join("src/lib.rs"), "fn f() {}\n").unwrap();
        assert_eq!(package(&fs::read_to_string(&manifest).unwrap()).as_deref(), Some("planted"));
        assert_eq!(differences(&manifest, "planted").unwrap(), [""; 0]);
        fs::write(folder.path().join("src/lib.rs"), "fn f( ) { }\n").unwrap();
        assert!(differences(&manifest, "planted").unwrap()[0].contains("fn f() {}"));
    }
}
