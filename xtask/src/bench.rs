//! `bench`: measures beside other programs, and writes the page. No part of CI: a page is measured when it
//! changes, on a quiet machine.

pub mod casadi;
pub mod python;

use anyhow::{Context, Result};
use xshell::{Shell, cmd};

/// The name of this machine's processor.
fn processor(shell: &Shell) -> Result<String> {
    let text = shell.read_file("/proc/cpuinfo")?;
    let name =
        text.lines().filter(|line| line.starts_with("model name")).find_map(|line| line.split_once(": "));
    Ok(name.context("the processor has no name")?.1.to_owned())
}

/// The first line that a program prints of its version.
fn version(shell: &Shell, program: &str) -> Result<String> {
    let text = cmd!(shell, "{program} --version").quiet().read()?;
    Ok(text.lines().next().unwrap_or_default().to_owned())
}
