//! An environment of Python with packages of PyPI.

use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};
use xshell::{Shell, cmd};

/// Makes an environment in a folder, with these packages, and returns the folder of its programs.
pub fn make(shell: &Shell, folder: &Path, packages: &[&str]) -> Result<PathBuf> {
    let environment = folder.join("python");
    let made = cmd!(shell, "python3 -m venv {environment}").quiet().ignore_status().output();
    ensure!(made.is_ok_and(|made| made.status.success()), "python3 cannot make an environment");
    let programs = environment.join("bin");
    let pip = programs.join("pip");
    let install = cmd!(shell, "{pip} install --quiet --disable-pip-version-check {packages...}");
    let installed = install.quiet().ignore_status().output()?;
    let why = String::from_utf8_lossy(&installed.stderr);
    let last = why.lines().last().unwrap_or_default();
    ensure!(installed.status.success(), "{} cannot be installed: {last}", packages.join(", "));
    Ok(programs)
}
