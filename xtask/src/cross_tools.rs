//! Emulators of microcontrollers, compilers for them, and `core`.

use anyhow::Result;
use xshell::Shell;

use crate::core_sources;
use crate::tools::{self, NotChecked};

/// Arguments of cargo that build `core`.
pub const CORE: [&str; 2] = ["-Zbuild-std=core", "-Zbuild-std-features=compiler-builtins-mem"];

/// Installs the tools, those for RISC-V if they are asked for, and provides the sources of `core`.
pub fn prepare(shell: &Shell, is_riscv: bool) -> Result<()> {
    let mut tools = vec![
        ("qemu-system-arm", "qemu-system-arm"),
        ("qemu-system-riscv32", "qemu-system-misc"),
        ("arm-none-eabi-gcc", "gcc-arm-none-eabi"),
        ("make", "make"),
    ];
    if is_riscv {
        tools.push(("riscv64-unknown-elf-gcc", "gcc-riscv64-unknown-elf"));
    }
    let provided = tools::require(shell, &tools).and_then(|()| core_sources::provide(shell));
    Ok(provided.map_err(|error| NotChecked::new("FIRMWARE", error))?)
}
