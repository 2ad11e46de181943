//! A particle in a ring potential and a double pendulum, both damped, as functions of a WebAssembly module.

#![cfg_attr(target_arch = "wasm32", no_std)]

mod runge_kutta;

use dalembert::{Gauss, Midpoint, Trapezoidal, rayleigh_system};

pub use runge_kutta::{Motion, runge_kutta_4};

dalembert_c::parameters! {
    /// A particle of unit mass in the plane, in the potential s(s − 1)², s = |q|². All quantities are dimensionless.
    pub struct Ring {
        /// Coefficient of the drag.
        pub friction: f64,
    }
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.friction * (v[0] * v[0] + v[1] * v[1])
    }
}

dalembert_c::parameters! {
    /// Two masses of 1 kg on massless rods of 1 m, one hung from the other; q are the angles from the vertical, in rad.
    pub struct DoublePendulum {
        /// Friction of either joint, N m s.
        pub friction: f64,
        /// Acceleration of gravity, m/s².
        pub gravity: f64,
    }
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl DoublePendulum {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let kinetic = v[0] * v[0] + 0.5 * v[1] * v[1] + v[0] * v[1] * (q[0] - q[1]).cos();
        kinetic + self.gravity * (2.0 * q[0].cos() + q[1].cos())
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.friction * (v[0] * v[0] + (v[1] - v[0]).powi(2))
    }
}

dalembert_c::c_api! { ring_midpoint: Ring, rule: Midpoint }
dalembert_c::c_api! { ring_trapezoidal: Ring, rule: Trapezoidal }
dalembert_c::c_api! { ring_gauss: Ring, rule: Gauss<2> }
dalembert_c::c_api! { ring_reference: Ring, rule: Gauss<4> }

dalembert_c::c_api! { double_pendulum_midpoint: DoublePendulum, rule: Midpoint }
dalembert_c::c_api! { double_pendulum_trapezoidal: DoublePendulum, rule: Trapezoidal }
dalembert_c::c_api! { double_pendulum_gauss: DoublePendulum, rule: Gauss<2> }
dalembert_c::c_api! { double_pendulum_reference: DoublePendulum, rule: Gauss<4> }

/// RK4 in the module, so that both methods are compiled alike.
macro_rules! runge_kutta {
    ($name:ident: $system:ident) => {
        #[doc = concat!("Takes a step of RK4 from `motion`, as [`runge_kutta_4`] does; ")]
        /// the page passes addresses of a [`Motion`] and of the parameters.
        // The name is exported, and that is all that is unsafe: no other module defines it.
        #[unsafe(no_mangle)]
        pub extern "C" fn $name(system: &$system, h: f64, motion: &mut Motion<2>) {
            *motion = runge_kutta_4(system, h, motion);
        }
    };
}

runge_kutta!(ring_runge_kutta: Ring);
runge_kutta!(double_pendulum_runge_kutta: DoublePendulum);

/// Ends the call with an exception in the page.
#[cfg(target_arch = "wasm32")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    core::arch::wasm32::unreachable()
}
