//! The C functions that `main.c` calls: of the pushed cart-pole, and one that the control of the proof calls.

#![cfg_attr(target_os = "none", no_std)]

dalembert_c::no_panic!();

/// In `f32`.
pub mod single {
    use dalembert::Midpoint;
    use firmware_scenes::single::{DrivenPushedCartPole, PushedCartPole};

    dalembert_c::c_api! {
        cart_pole_f32: PushedCartPole, coordinates: 2, rule: Midpoint, driven: DrivenPushedCartPole, inputs: 1
    }
}

/// In `f64`.
pub mod double {
    use dalembert::Midpoint;
    use firmware_scenes::double::{DrivenPushedCartPole, PushedCartPole};

    dalembert_c::c_api! {
        cart_pole_f64: PushedCartPole, coordinates: 2, rule: Midpoint, driven: DrivenPushedCartPole, inputs: 1
    }
}

/// Positive control: it may be out of bounds, and a program that calls it must not link.
#[unsafe(no_mangle)]
pub extern "C" fn may_panic(index: usize) -> u32 {
    [1, 2, 3][index]
}
