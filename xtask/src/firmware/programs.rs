//! The programs of a machine, in Rust and in C: built, linked, emulated, held against the host.

use std::collections::BTreeSet;
use std::process::Output;

use anyhow::{Result, ensure};
use xshell::{Cmd, Shell, cmd};

use super::machines::Machine;
use crate::core_sources::BUILT;
use crate::cross_tools::CORE;
use crate::tools;

/// The program in C, in the workspace of the firmware.
pub const IN_C: &str = "target/in_c/program";

const TEMPLATE: &str = "../examples/firmware-c";

/// The programs of a machine at an opt-level.
pub struct Programs<'a> {
    /// A shell in the workspace of the firmware.
    pub shell: &'a Shell,
    /// The machine.
    pub machine: &'a Machine,
    /// The opt-level.
    pub level: &'a str,
    /// All functions of C. They are linked, those that main.c does not call too: the proof is of each.
    pub functions: &'a BTreeSet<String>,
}

/// Writes the headers of the programs in C, and returns the functions that they declare, but those that begin
/// a run.
pub fn headers(shell: &Shell) -> Result<BTreeSet<String>> {
    let mut all = BTreeSet::new();
    for prefix in ["cart_pole_f32", "cart_pole_f64"] {
        let header = cmd!(shell, "target/release/firmware-header {prefix}").quiet().output()?;
        let found = functions(&String::from_utf8_lossy(&header.stdout), prefix);
        ensure!(!found.is_empty(), "the header of {prefix} has no functions");
        all.extend(found);
        shell.write_file(format!("target/in_c/{prefix}.h"), header.stdout)?;
    }
    Ok(all)
}

fn functions(header: &str, prefix: &str) -> BTreeSet<String> {
    let names = header
        .split('(')
        .filter_map(|before| before.rsplit(|c: char| !c.is_alphanumeric() && c != '_').next());
    let is_function = |name: &&str| {
        let rest = name.strip_prefix(prefix).and_then(|rest| rest.strip_prefix('_'));
        rest.is_some_and(|rest| !rest.is_empty() && rest.chars().all(|c| c.is_ascii_lowercase() || c == '_'))
    };
    names.filter(is_function).filter(|name| !name.ends_with("_init")).map(str::to_owned).collect()
}

impl Programs<'_> {
    /// The program in Rust.
    pub fn device(&self) -> String {
        format!("{BUILT}/{}/release/firmware-device", self.machine.target)
    }

    /// Builds with cargo.
    pub fn build(&self, arguments: &[&str]) -> Result<Output> {
        let target = self.machine.target;
        let build = cmd!(self.shell, "cargo build --release --target {target} {CORE...} {arguments...}");
        let build =
            build.env("ORIGIN", self.machine.flash).env("CARGO_PROFILE_RELEASE_OPT_LEVEL", self.level);
        let build = build.env("RUSTFLAGS", format!("-C target-cpu={}", self.machine.processor));
        Ok(build.quiet().ignore_status().output()?)
    }

    /// Links the program in C, with the template's start.
    pub fn link(&self, arguments: &[&str]) -> Result<Output> {
        let Machine { target, flash, ram, start, .. } = self.machine;
        let script = "target/in_c/link.ld";
        let sections = self.of_words(self.machine.gcc).args(["-E", "-P", "-x", "c"]);
        let sections = sections.args([format!("-DFLASH_AT={flash}"), format!("-DRAM_AT={ram}")]);
        sections.args(["-o", script]).arg(format!("{TEMPLATE}/boards/sections.ld")).run()?;

        let link = self.of_words(self.machine.gcc);
        let link = link.args(["-O2", "-std=c11", "-Wall", "-Wextra", "-Wconversion", "-Werror"]);
        let link = link.args(["-ffreestanding", "-nostdlib", "-Itarget/in_c"]);
        let link = link.arg(format!("-I{TEMPLATE}/boards")).args(["-o", IN_C, "in_c/main.c"]);
        let link = link
            .arg(format!("{TEMPLATE}/{start}"))
            .arg(format!("{BUILT}/{target}/release/libfirmware_in_c.a"));
        let link = link.args(["-T", script, "-Wl,--gc-sections,-z,noexecstack"]);
        let link = link.args(self.functions.iter().map(|function| format!("-Wl,--undefined={function}")));
        Ok(link.args(arguments).ignore_status().output()?)
    }

    /// Runs a program in the emulator.
    pub fn emulate(&self, program: &str) -> Result<Output> {
        let emulate = self.of_words(&format!("timeout 120 {}", self.machine.emulator));
        let emulate = emulate.args(["-display", "none", "-monitor", "none", "-serial", "none"]);
        let emulate = emulate.args(["-chardev", "stdio,id=report", "-semihosting-config"]);
        let emulate = emulate.args(["enable=on,target=native,chardev=report", "-kernel", program]);
        Ok(emulate.ignore_status().output()?)
    }

    /// Holds what the programs reported against the host, and prints it.
    pub fn compare(&self, report: &[u8]) -> Result<()> {
        let (machine, level) = (self.machine.name, self.level);
        let host = cmd!(self.shell, "target/release/firmware-host {machine} {level}");
        Ok(host.quiet().stdin(report).run()?)
    }

    /// Whether an allocator is in a program, as far as there is an `nm` to see it.
    pub fn has_allocator(&self, program: &str) -> Result<bool> {
        if !tools::is_there("nm") {
            return Ok(false);
        }
        let names = cmd!(self.shell, "nm {program}").quiet().ignore_status().read()?;
        Ok(["__rust_alloc", "__rg_alloc"].iter().any(|allocator| names.contains(allocator)))
    }

    fn of_words(&self, command: &str) -> Cmd<'_> {
        let mut words = command.split(' ');
        self.shell.cmd(words.next().unwrap_or_default()).args(words).quiet()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_are_those_that_the_header_declares() {
        let header = "dalembert_status arm_step(arm_memory *m);\nint arm_init(int);\n#define other_step(x)\nint arm_text (arm2_a(";
        assert_eq!(functions(header, "arm"), BTreeSet::from(["arm_step".to_owned()]));
    }
}
