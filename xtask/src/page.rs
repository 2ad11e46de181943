//! `page`: follows the commands of a chapter of `docs/`, as a reader would, and holds what comes of it
//! against runs of this machine.

pub mod browser;
pub mod c;
pub mod clusters;
pub mod firmware_c;
pub mod fmu;
pub mod python;

use std::env;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use xshell::{Cmd, Shell, cmd};

use crate::{markdown, project};

/// The blocks of commands of a page, or of one of its chapters: no fewer than are known.
fn commands(page: &str, chapter: Option<&str>, least: usize) -> Result<Vec<String>> {
    let blocks = markdown::commands(&project::text(page)?, chapter);
    ensure!(blocks.len() >= least, "{page} has lost its commands");
    Ok(blocks)
}

/// Prints commands as a reader sees them.
fn show(commands: &str) {
    commands.lines().for_each(|line| println!("$ {line}"));
}

/// A shell's command that runs commands up to the first that fails.
fn script<'s>(shell: &'s Shell, commands: &str) -> Cmd<'s> {
    cmd!(shell, "bash -euo pipefail -c {commands}").quiet()
}

/// Gives the commands of the shell a home of its own, and the toolchain of the other.
fn move_home(shell: &Shell, to: &Path) -> Result<()> {
    let home = env::var_os("HOME").context("HOME is not set")?;
    for (variable, folder) in [("CARGO_HOME", ".cargo"), ("RUSTUP_HOME", ".rustup")] {
        shell
            .set_var(variable, env::var_os(variable).unwrap_or_else(|| Path::new(&home).join(folder).into()));
    }
    shell.set_var("HOME", to);
    Ok(())
}

/// Prints the line of a program's output that the page promises, or fails with all of it.
fn expect_line(output: &str, words: &str) -> Result<()> {
    let found: Vec<_> = output.lines().filter(|line| line.contains(words)).collect();
    ensure!(!found.is_empty(), "no line says {words:?}:\n{output}");
    println!("{}", found.join("\n"));
    Ok(())
}
