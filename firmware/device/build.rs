//! The linker script of the machine named by `ORIGIN`, the address where its memory begins.

use std::path::PathBuf;
use std::{env, fs};

fn main() {
    println!("cargo:rerun-if-env-changed=ORIGIN");
    let origin = env::var("ORIGIN").unwrap_or_else(|_| "0x00000000".to_owned());
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let script = format!("MEMORY {{ RAM (rwx) : ORIGIN = {origin}, LENGTH = 512K }}\n{SECTIONS}");
    fs::write(folder.join("link.x"), script).expect("OUT_DIR is writable");
    println!("cargo:rustc-link-search={}", folder.display());
    println!("cargo:rustc-link-arg=-Tlink.x");
    println!("cargo:rustc-link-arg=--gc-sections");
}

/// All in one memory that the emulator fills from the file, zeros of `.bss` included: nothing to copy at
/// start.
const SECTIONS: &str = "ENTRY(reset)
SECTIONS
{
  .start : { KEEP(*(.start)) } > RAM
  .text : { *(.text .text.*) } > RAM
  .rodata : { *(.rodata .rodata.*) } > RAM
  .data : { *(.data .data.* .sdata .sdata.*) } > RAM
  .bss : { *(.bss .bss.* .sbss .sbss.*) } > RAM
  .stack (NOLOAD) : ALIGN(16)
  {
    stack_limit = .;
    . = . + 32K;
    stack_top = .;
  } > RAM
  /DISCARD/ : { *(.ARM.exidx*) *(.ARM.extab*) *(.eh_frame*) }
}
";
