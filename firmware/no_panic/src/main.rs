//! Links only if no step can panic: its panic handler calls a function that does not exist.
//!
//! A handler that nothing reaches is left out of the program, and its call with it. Steps of n = 1…8
//! coordinates in `f64` and `f32`, with and without a guess, of bounded work, alone and in a trajectory: by
//! midpoint and trapezoidal rule with dense mass matrices, friction and a general force; by the midpoint rule
//! with banded Newton matrices, n = 4…8; by the fitted rules, the one-sided one and the explicit trapezoidal
//! rule, its composition and its splitting; steps of n = 1…3 coordinates by Gauss rules, with an input and
//! time, and every derivative of them; steps on constraints, one of them redundant, with reactions and A; and
//! tables of each kind in L, R and f. Certificates are not among them. `cargo xtask no-panic` builds it at
//! opt-level 3 and s, and with the feature `may-panic`, which must fail.

#![no_std]
#![no_main]
// The control needs but some of the steps.
#![cfg_attr(feature = "may-panic", allow(dead_code))]

mod constrained;
mod frictional;
mod gauss;
mod systems;
mod tabled;

use core::hint::black_box;
use core::panic::PanicInfo;

// Start-up code and `memcpy` are the C library's.
#[link(name = "c")]
unsafe extern "C" {
    /// Defined nowhere.
    fn a_panic_is_left_in_the_program() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    // SAFETY: never linked, hence never called.
    unsafe { a_panic_is_left_in_the_program() }
}

/// What the C runtime calls.
#[unsafe(no_mangle)]
pub extern "C" fn main() -> i32 {
    #[cfg(not(feature = "may-panic"))]
    let failed = systems::step_all()
        + gauss::step_all()
        + constrained::step_all()
        + frictional::step_all()
        + tabled::step_all();
    #[cfg(feature = "may-panic")]
    let failed = [1, 2, 3][black_box(gauss::step_all()) as usize];
    black_box(failed)
}
