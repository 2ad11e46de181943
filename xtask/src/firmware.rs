//! `firmware`: steps the scenes on emulated microcontrollers, in Rust and through the functions of C, and
//! proves of each program that it cannot panic; then follows the chapter on C on a microcontroller.

mod machines;
mod programs;

use std::process::Output;

use anyhow::{Result, bail, ensure};
use xshell::cmd;

use crate::no_panic::LEFT;
use crate::tools::said;
use crate::{cross_tools, page, project};
use machines::MACHINES;
use programs::Programs;

/// Takes one machine, or all.
pub fn run(only: Option<&str>) -> Result<()> {
    let machines: Vec<_> =
        MACHINES.iter().filter(|machine| only.is_none_or(|only| machine.name == only)).collect();
    let name = only.unwrap_or_default();
    ensure!(!machines.is_empty(), "no machine is {name:?}: there are m4f, m7, m33 and rv");
    let shell = project::shell()?;
    let host = shell.clone();
    host.change_dir("firmware");
    // RISC-V's compiler is not fetched where it is not asked for.
    cross_tools::prepare(&shell, only.is_none_or(|only| only == "rv"))?;
    shell.change_dir("firmware");
    cmd!(host, "cargo build --quiet --release -p firmware-host -p firmware-in-c --bins").run()?;
    let functions = programs::headers(&shell)?;
    for machine in machines {
        for level in ["3", "s"] {
            let programs = Programs { shell: &shell, machine, level, functions: &functions };
            if let Err(error) = of_programs(&programs) {
                bail!("{}, opt-level {level}: {error:#}", machine.name);
            }
        }
    }
    if only.is_none_or(|only| only == "m7") {
        page::firmware_c::follow(&shell, only.is_some())?;
    }
    println!(
        "firmware: same bits as the host, no panic, no allocator, instructions and stack below their ceilings, in Rust \
         and in C"
    );
    Ok(())
}

/// Builds, runs and holds against the host the programs of a machine at an opt-level; and links their
/// controls.
fn of_programs(programs: &Programs) -> Result<()> {
    for built in
        [programs.build(&["-p", "firmware-device"])?, programs.build(&["-p", "firmware-in-c", "--lib"])?]
    {
        ensure!(built.status.success(), "{}", said(&built));
    }
    let linked = programs.link(&[])?;
    ensure!(linked.status.success(), "{}", said(&linked));
    // Neither a panic nor an allocator is in the programs: the controls show that the first would not have
    // linked.
    for program in [programs.device(), programs::IN_C.to_owned()] {
        ensure!(!programs.has_allocator(&program)?, "an allocator is in {program}");
    }
    let mut report = Vec::new();
    for program in [programs.device(), programs::IN_C.to_owned()] {
        let run = programs.emulate(&program)?;
        report.extend_from_slice(&run.stdout);
        ensure!(run.status.success(), "a step failed: {}{}", String::from_utf8_lossy(&report), said(&run));
    }
    programs.compare(&report)?;
    refused(&programs.build(&["-p", "firmware-device", "--features", "may-panic"])?)?;
    refused(&programs.link(&["-DMAY_PANIC"])?)
}

/// Sees that the control was not linked, for the panic that is left in it.
fn refused(control: &Output) -> Result<()> {
    ensure!(!control.status.success(), "a program that can panic was linked");
    let log = said(control);
    ensure!(log.contains(LEFT), "{log}");
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::os::unix::process::ExitStatusExt;
    use std::process::ExitStatus;

    use super::*;

    #[test]
    fn only_a_link_that_fails_for_a_panic_is_a_refusal() {
        let link = |code, log: &str| Output {
            status: ExitStatus::from_raw(code << 8),
            stdout: Vec::new(),
            stderr: log.as_bytes().to_vec(),
        };
        assert!(refused(&link(1, "undefined reference to `a_panic_is_left_in_the_program'")).is_ok());
        assert!(refused(&link(1, "no such file")).is_err());
        assert!(refused(&link(0, "a_panic_is_left_in_the_program")).is_err());
    }
}
