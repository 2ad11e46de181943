//! Cortex-M: start, semihosting, and SysTick as a counter of instructions.

use core::arch::{asm, global_asm};
use core::ptr;

global_asm!(
    ".section .start, \"ax\"",
    ".word stack_top",
    ".word reset",
    ".rept 14",
    ".word fault",
    ".endr",
    ".thumb_func",
    ".global reset",
    "reset:",
    // Access to the floating-point unit: CPACR.
    "ldr r0, =0xe000ed88",
    "ldr r1, [r0]",
    "orr r1, r1, #0xf00000",
    "str r1, [r0]",
    "dsb",
    "isb",
    // The stack is painted, so that its use shows.
    "ldr r0, =stack_limit",
    "ldr r1, =stack_top",
    "ldr r2, ={paint}",
    "1: str r2, [r0], #4",
    "cmp r0, r1",
    "blo 1b",
    "bl start",
    ".thumb_func",
    "fault:",
    "mov r0, #0x18",
    "mov r1, #0",
    "bkpt 0xab",
    "b fault",
    paint = const crate::PAINT,
);

/// One semihosting call.
fn call(operation: u32, argument: *const u32) -> u32 {
    let result;
    // SAFETY: the emulator reads what the argument points to, and writes nothing for the operations used
    // here.
    unsafe { asm!("bkpt 0xab", inlateout("r0") operation => result, in("r1") argument) }
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

const CONTROL: *mut u32 = 0xe000_e010 as *mut u32;
const RELOAD: *mut u32 = 0xe000_e014 as *mut u32;
const CURRENT: *mut u32 = 0xe000_e018 as *mut u32;

/// Instructions of the loop that tells how many ticks an instruction is.
const CALIBRATION: u32 = 100_000;

/// Counts instructions by ticks of the system timer, which the emulator derives from the instructions
/// executed.
pub struct Counter {
    /// Ticks of [`CALIBRATION`] instructions.
    ticks: u64,
}

impl Counter {
    pub fn new() -> Self {
        // SAFETY: the timer's registers, which nothing else uses.
        unsafe {
            ptr::write_volatile(RELOAD, 0xff_ffff);
            ptr::write_volatile(CURRENT, 0);
            ptr::write_volatile(CONTROL, 5);
        }
        let from = now();
        // SAFETY: a loop of two instructions.
        unsafe { asm!("1: subs {n}, {n}, #1", "bne 1b", n = inout(reg) CALIBRATION / 2 => _) }
        Self { ticks: u64::from(elapsed(from)) }
    }

    /// Instructions that `work` takes.
    #[inline(never)]
    pub fn instructions(&self, work: impl FnOnce()) -> u32 {
        let from = now();
        work();
        let ticks = u64::from(elapsed(from));
        (ticks * u64::from(CALIBRATION)).checked_div(self.ticks).unwrap_or(0) as u32
    }
}

fn now() -> u32 {
    // SAFETY: a register of the timer; reading it changes nothing.
    unsafe { ptr::read_volatile(CURRENT) }
}

/// Ticks since `from`: the timer counts down, through 24 bits.
fn elapsed(from: u32) -> u32 {
    from.wrapping_sub(now()) & 0xff_ffff
}
