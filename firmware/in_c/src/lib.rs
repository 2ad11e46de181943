//! The C functions that `main.c` calls: of the pushed cart-pole, and one that the control of the proof calls.

#![cfg_attr(target_os = "none", no_std)]

dalembert_c::no_panic!();

/// In `f32`.
pub mod single {
    use dalembert::Midpoint;
    use firmware_scenes::single::PushedCartPole;

    dalembert_c::c_api! { cart_pole_f32: PushedCartPole, rule: Midpoint, takes: [u] }
}

/// In `f64`.
pub mod double {
    use dalembert::Midpoint;
    use firmware_scenes::double::PushedCartPole;

    dalembert_c::c_api! { cart_pole_f64: PushedCartPole, rule: Midpoint, takes: [u] }
}

/// Positive control: it may be out of bounds, and a program that calls it must not link.
#[unsafe(no_mangle)]
pub extern "C" fn may_panic(index: usize) -> u32 {
    [1, 2, 3][index]
}
