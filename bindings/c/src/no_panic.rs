//! Panics where there is no operating system.

/// Panics, in a library for bare metal: the program links only if the linker finds none in it.
///
/// A crate without `std` says what a panic does. Here it calls a function that is defined nowhere. Where the
/// compiler has removed every panic from what C calls, as it does with `lto = "fat"` and `codegen-units = 1`,
/// the linker leaves the call out (`-Wl,--gc-sections`); else it names `a_panic_is_left_in_the_program`. On a
/// host this is nothing.
#[macro_export]
macro_rules! no_panic {
    () => {
        #[cfg(target_os = "none")]
        #[panic_handler]
        fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
            $crate::boundary::a_panic_is_left_in_the_program()
        }
    };
}
