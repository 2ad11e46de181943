//! The chapter "On a microcontroller, from C" of `docs/embedding.md`.

use anyhow::{Context, Result, ensure};
use xshell::{Shell, cmd};

use super::{commands, expect_line, move_home, script, show};
use crate::{cross_tools, project, tools};

/// Follows all of the chapter.
pub fn run() -> Result<()> {
    let shell = project::shell()?;
    cross_tools::prepare(&shell, true)?;
    follow(&shell, false)
}

/// Follows the chapter, or only the first of its programs, built where it stands and with the header that it
/// has.
pub fn follow(shell: &Shell, is_first_alone: bool) -> Result<()> {
    let shell = shell.clone();
    shell.change_dir(project::root());
    let mut commands = commands("docs/embedding.md", Some("On a microcontroller, from C"), 2)?.concat();
    ensure!(commands.matches("make -C").count() >= 3, "the chapter has lost its commands");
    if is_first_alone {
        let is_run = |line: &&str| line.starts_with("make ") && line.ends_with(" run");
        commands = commands.lines().find(is_run).context("no command that runs the program")?.to_owned();
        cmd!(shell, "touch examples/firmware-c/include/cart_pole.h").quiet().run()?;
    }
    cmd!(shell, "cargo fmt --manifest-path examples/firmware-c/Cargo.toml --check").run()?;
    show(&commands);
    let home = shell.create_temp_dir()?;
    move_home(&shell, home.path())?;
    shell.set_var("CARGOFLAGS", cross_tools::CORE.join(" "));
    let output = script(&shell, &commands).ignore_status().output()?;
    let said = tools::said(&output);
    ensure!(output.status.success(), "{said}");
    expect_line(&said, "from upright")
}
