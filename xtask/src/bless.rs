//! `bless`: writes anew what tests compare with, to be read as a diff before it is committed.

use anyhow::Result;
use xshell::cmd;

use crate::project;
use crate::tidy::guide_pictures;

/// Writes the snapshots of expansions, the messages of the diagnostics, and the guide's pictures.
pub fn run() -> Result<()> {
    let shell = project::shell()?;
    guide_pictures::write(&shell)?;
    cmd!(shell, "cargo test -p dalembert-macros snapshots").env("UPDATE_SNAPSHOTS", "1").run()?;
    cmd!(shell, "cargo test -p dalembert-diagnostics").env("TRYBUILD", "overwrite").run()?;
    cmd!(shell, "git --no-pager diff --stat").quiet().run()?;
    Ok(())
}
