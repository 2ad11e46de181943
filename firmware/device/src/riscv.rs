//! RISC-V: start, semihosting, and the counter of retired instructions.

use core::arch::{asm, global_asm};

global_asm!(
    ".section .start, \"ax\"",
    ".global reset",
    "reset:",
    "la t0, fault",
    "csrw mtvec, t0",
    // The stack is painted, so that its use shows.
    "la t0, stack_limit",
    "la sp, stack_top",
    "li t1, {paint}",
    "1: sw t1, 0(t0)",
    "addi t0, t0, 4",
    "bltu t0, sp, 1b",
    "call start",
    ".balign 4",
    "fault:",
    "li a0, 0x18",
    "li a1, 0",
    ".balign 16",
    ".option push",
    ".option norvc",
    "slli x0, x0, 0x1f",
    "ebreak",
    "srai x0, x0, 7",
    ".option pop",
    "j fault",
    paint = const crate::PAINT,
);

/// One semihosting call.
fn call(operation: u32, argument: *const u32) -> u32 {
    let result;
    // SAFETY: the emulator reads what the argument points to, and writes nothing for the operations used
    // here. It knows the call by these three instructions, on one page.
    unsafe {
        asm!(
            ".balign 16",
            ".option push",
            ".option norvc",
            "slli x0, x0, 0x1f",
            "ebreak",
            "srai x0, x0, 7",
            ".option pop",
            inlateout("a0") operation => result,
            in("a1") argument,
        )
    }
    result
}

/// Writes text that ends with a zero byte.
pub fn write(text: &[u8]) {
    call(0x04, text.as_ptr().cast());
}

/// Ends the emulation.
pub fn exit(code: u32) -> ! {
    let block = [0x2_0026, code];
    loop {
        call(0x20, block.as_ptr());
    }
}

/// Counts instructions.
pub struct Counter;

impl Counter {
    pub fn new() -> Self {
        Self
    }

    /// Instructions that `work` takes.
    #[inline(never)]
    pub fn instructions(&self, work: impl FnOnce()) -> u32 {
        let from = now();
        work();
        now().wrapping_sub(from)
    }
}

fn now() -> u32 {
    let count;
    // SAFETY: a counter; reading it changes nothing.
    unsafe { asm!("csrr {}, minstret", out(reg) count) }
    count
}
