//! Programs that tasks call: those of the system's packages are installed where that is allowed.

use std::error::Error;
use std::fmt::{self, Display, Formatter};
use std::path::PathBuf;
use std::process::Output;
use std::{env, iter};

use anyhow::{Result, ensure};
use xshell::{Shell, cmd};

/// A task that checked nothing, since a tool is missing and cannot be had. It fails where `CI` is set alone.
#[derive(Debug)]
pub struct NotChecked {
    what: &'static str,
    why: String,
}

impl NotChecked {
    /// `what` was not checked, and `why`.
    pub fn new(what: &'static str, why: impl Display) -> Self {
        Self { what, why: why.to_string() }
    }
}

impl Display for NotChecked {
    fn fmt(&self, to: &mut Formatter) -> fmt::Result {
        write!(to, "!! {} NOT CHECKED: {}", self.what, self.why)
    }
}

impl Error for NotChecked {}

/// Whether the variable `CI` is set.
pub fn is_ci() -> bool {
    env::var_os("CI").is_some_and(|value| !value.is_empty())
}

/// The program of this name, also where those of the system's daemons are.
pub fn path(program: &str) -> Option<PathBuf> {
    let path = env::var_os("PATH").unwrap_or_default();
    let folders = env::split_paths(&path).chain(iter::once("/usr/sbin".into()));
    folders.map(|folder| folder.join(program)).find(|program| program.is_file())
}

/// Whether there is a program of this name.
pub fn is_there(program: &str) -> bool {
    path(program).is_some()
}

/// Installs packages of the distribution, as root on Debian.
pub fn install(shell: &Shell, packages: &[&str]) -> Result<()> {
    let missing = packages.join(", ");
    let is_root = cmd!(shell, "id -u").quiet().read().is_ok_and(|user| user == "0");
    ensure!(is_root && is_there("apt-get"), "{missing} missing, and no right to install them");
    // Lists that cannot be renewed may serve.
    let _ = cmd!(shell, "apt-get update").quiet().output();
    let install = cmd!(shell, "apt-get install -y --no-install-recommends {packages...}");
    let installed = install.env("DEBIAN_FRONTEND", "noninteractive").quiet().output();
    ensure!(installed.is_ok(), "{missing} cannot be installed");
    Ok(())
}

/// Installs the packages of programs, each given as (program, package), that are missing.
pub fn require(shell: &Shell, tools: &[(&str, &'static str)]) -> Result<()> {
    let missing: Vec<_> = tools.iter().filter(|tool| !is_there(tool.0)).map(|tool| tool.1).collect();
    if missing.is_empty() { Ok(()) } else { install(shell, &missing) }
}

/// All that a program printed.
pub fn said(output: &Output) -> String {
    [&output.stdout, &output.stderr].map(|said| String::from_utf8_lossy(said)).concat()
}
