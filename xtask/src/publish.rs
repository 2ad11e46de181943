//! `publish`: what must hold before the crates are published; `docs/evidence/publishing.md` says how it is
//! done.

mod dependencies;
mod documentation;
mod metadata;
mod packages;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use serde_json::Value;
use xshell::{Cmd, Shell, cmd};

use crate::{project, tools};

/// The crates in the order in which they are published: each needs those before it.
const PUBLISHED: [&str; 6] =
    ["dalembert-macros", "dalembert", "dalembert-face", "dalembert-c", "dalembert-fmu", "dalembert-ensemble"];

/// A look at what would be published.
struct Publication {
    /// A shell that stands in a clone of the last commit: files that are not committed do not count.
    shell: Shell,
    /// The folder for packages and for what is compiled of them.
    target: PathBuf,
    /// Failures, and parts that were not looked at.
    failures: Vec<String>,
    skipped: Vec<String>,
}

/// Looks at packages of the last commit: contents, metadata, licences; compiled and documented as downloaded.
/// With `all` also cargo's own verification, with all features, and known vulnerabilities.
pub fn run(all: bool) -> Result<()> {
    let shell = project::shell()?;
    let folder = shell.create_temp_dir()?;
    let (root, clone) = (project::root(), folder.path().join("dalembert"));
    cmd!(shell, "git clone --quiet {root} {clone}").quiet().run()?;
    let changed = cmd!(shell, "git status --porcelain").quiet().read()?;
    shell.change_dir(&clone);
    let target = project::target().join("publish");
    shell.set_var("CARGO_TARGET_DIR", &target);
    shell.set_var("CARGO_INCREMENTAL", "0");
    shell.set_var("CARGO_PROFILE_DEV_DEBUG", "none");
    let mut publication = Publication { shell, target, failures: Vec::new(), skipped: Vec::new() };
    if !changed.is_empty() {
        publication
            .skipped
            .push("changes that are not committed: only the last commit was looked at".to_owned());
    }
    publication.look(all)?;
    publication.sum_up()
}

impl Publication {
    fn look(&mut self, all: bool) -> Result<()> {
        metadata::check(self)?;
        let least = metadata::check_rust_versions(self)?;
        if let Some(packages) = packages::check(self)? {
            documentation::check_build(self, &packages, &least)?;
            documentation::check(self, &packages)?;
        }
        dependencies::check(self, all)?;
        dependencies::check_citation(self)?;
        if all {
            step("cargo's own verification of the packages");
            let shell = self.shell.clone();
            let package =
                cmd!(shell, "cargo package --offline --locked --all-features").args(of_packages(PUBLISHED));
            self.succeeds(package);
        }
        Ok(())
    }

    fn sum_up(&self) -> Result<()> {
        self.skipped.iter().for_each(|what| println!("SKIPPED {what}"));
        self.failures.iter().for_each(|what| println!("FAILED {what}"));
        match (self.failures.is_empty(), self.skipped.is_empty()) {
            (false, _) => bail!("not ready to publish"),
            (true, false) => println!("ready to publish, but for what was skipped"),
            (true, true) => println!("ready to publish"),
        }
        Ok(())
    }

    fn fail(&mut self, of: &str, what: impl AsRef<str>) {
        let what = what.as_ref();
        println!("   FAILED {of}: {what}");
        self.failures.push(format!("{of}: {what}"));
    }

    /// Whether a command succeeds; what it prints is seen only if it does not.
    fn succeeds(&mut self, command: Cmd) -> bool {
        let name = command.to_string();
        let output = command.quiet().ignore_status().output();
        let said = match &output {
            Ok(output) if output.status.success() => return true,
            Ok(output) => format!("{}{}", tools::said(output), output.status),
            Err(error) => error.to_string(),
        };
        println!("{said}");
        self.fail(
            &name.split(' ').take(3).collect::<Vec<_>>().join(" "),
            said.lines().last().unwrap_or_default(),
        );
        false
    }

    /// Whether a tool answers. Where `CI` is set it is installed first if it does not.
    fn has(&mut self, tool: Cmd, install: Cmd) -> bool {
        let name = tool.to_string();
        let name = name.rsplit('/').next().unwrap_or(&name);
        let answers = tool.quiet().ignore_status().output();
        if answers.is_ok_and(|output| output.status.success()) {
            return true;
        }
        if !tools::is_ci() {
            self.skipped
                .push(format!("what needs `{name}`, which is not installed: with CI=1 it is installed"));
            return false;
        }
        install.run().map_err(|error| self.fail("installation", error.to_string())).is_ok()
    }

    /// The metadata that cargo gives of the workspace in a folder.
    fn metadata(&self, at: &Path, arguments: &[&str]) -> Result<Value> {
        let _at = self.shell.push_dir(at);
        let text = cmd!(self.shell, "cargo metadata --format-version=1 {arguments...}").quiet().read()?;
        serde_json::from_str(&text).context("cargo metadata")
    }
}

fn step(what: &str) {
    println!("== {what}");
}

fn of_packages<'n>(names: impl IntoIterator<Item = &'n str>) -> impl Iterator<Item = &'n str> {
    names.into_iter().flat_map(|name| ["--package", name])
}

/// The packages of what cargo says.
fn packages_of(metadata: &Value) -> &[Value] {
    metadata["packages"].as_array().map_or(&[], Vec::as_slice)
}

/// The text at a key, empty where there is none.
fn text<'v>(of: &'v Value, key: &str) -> &'v str {
    of[key].as_str().unwrap_or_default()
}
