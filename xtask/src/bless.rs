//! `bless`: writes anew what tests compare with, to be read as a diff before it is committed.

use anyhow::Result;
use xshell::cmd;

use crate::project;

/// Writes the snapshots of expansions, and the messages of the diagnostics.
pub fn run() -> Result<()> {
    let shell = project::shell()?;
    cmd!(shell, "cargo test -p dalembert-macros snapshots").env("UPDATE_SNAPSHOTS", "1").run()?;
    cmd!(shell, "cargo test -p dalembert-diagnostics").env("TRYBUILD", "overwrite").run()?;
    cmd!(shell, "git --no-pager diff --stat").quiet().run()?;
    Ok(())
}
