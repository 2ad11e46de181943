//! A Slurm of its own on this machine.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use anyhow::{Context, Result, ensure};
use xshell::Shell;

use crate::project;

/// A running Slurm. The script that keeps it stops it when its own input ends: also where this program is
/// killed, when no destructor runs.
pub struct OneMachine {
    keeper: Child,
    home: PathBuf,
}

impl OneMachine {
    /// Starts one, which the commands of the shell use from now on.
    pub fn start(shell: &Shell) -> Result<Self> {
        let mut script = Command::new("bash");
        script.arg("ensemble/tests/slurm/one_machine").current_dir(project::root());
        script.stdin(Stdio::piped()).stdout(Stdio::piped());
        let keeper = script.spawn().context("bash")?;
        let mut machine = Self { keeper, home: PathBuf::new() };
        let output = machine.keeper.stdout.take().context("its output")?;
        let mut line = String::new();
        BufReader::new(output).read_line(&mut line)?;
        ensure!(!line.is_empty(), "no Slurm could be started");
        machine.home = line.trim_end().into();
        shell.set_var("SLURM_CONF", machine.home.join("slurm.conf"));
        Ok(machine)
    }

    /// A folder that jobs see, and that is removed in the end.
    pub fn home(&self) -> &Path {
        &self.home
    }
}

impl Drop for OneMachine {
    fn drop(&mut self) {
        drop(self.keeper.stdin.take());
        let _ = self.keeper.wait();
    }
}
