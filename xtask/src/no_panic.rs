//! `no-panic`: the proof at link time that no step can panic, and that the proof can fail.

use anyhow::{Result, bail, ensure};
use xshell::cmd;

use crate::project;

/// The function that is called by a panic, and is defined nowhere.
pub const LEFT: &str = "a_panic_is_left_in_the_program";

/// Proves it at each of the opt-levels.
pub fn run(levels: &[&str]) -> Result<()> {
    let shell = project::shell()?;
    shell.change_dir("firmware");
    let _panic = shell.push_env("CARGO_PROFILE_RELEASE_PANIC", "abort");
    for level in levels {
        ensure!(["3", "s"].contains(level), "the proof is of opt-level 3 and s, not {level}");
        let _level = shell.push_env("CARGO_PROFILE_RELEASE_OPT_LEVEL", level);
        cmd!(shell, "cargo build --quiet --release -p firmware-no-panic").run()?;
        let steps = cmd!(shell, "target/release/firmware-no-panic").ignore_status().output()?;
        ensure!(steps.status.success(), "opt-level {level}: steps failed, {}", steps.status);
        let control = cmd!(shell, "cargo build --release -p firmware-no-panic --features may-panic");
        let control = control.quiet().ignore_status().output()?;
        if control.status.success() {
            bail!("opt-level {level}: a program that can panic was linked; the proof proves nothing");
        }
        let log = String::from_utf8_lossy(&control.stderr);
        ensure!(log.contains(LEFT), "opt-level {level}: {log}");
        println!(
            "opt-level {level}: no step can panic, n = 1…8, f64 and f32, nor by Gauss rules, n = 1…3, with their \
             derivatives; the control that can does not link"
        );
    }
    Ok(())
}
