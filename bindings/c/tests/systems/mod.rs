//! Systems of every kind that C can be given: with and without input, time, constraints and tables, in `f64`
//! and `f32`, by three rules.

pub mod constrained;
pub mod tables;

#[path = "../../../../examples/c/src/lib.rs"]
mod template;

pub use template::{CartPole, DrivenCartPole, cart_pole};

use dalembert::{Gauss, Midpoint, Trapezoidal, rayleigh_system};

dalembert_c::parameters! {
    /// A particle in a ring, with drag; fields of all shapes.
    ///
    /// A comment */ that would end C's.
    pub struct Ring {
        /// Shifts the next field, in C as here.
        pub name: u8,
        /// Drag.
        pub k: f32,
        /// Weights of the potential's terms.
        pub weights: [[f32; 3]; 2],
        /// Not used.
        pub turns: [i16; 3],
    }
}

#[rayleigh_system(parameters = [k])]
impl Ring {
    fn lagrangian(&self, q: [f32; 2], v: [f32; 2]) -> f32 {
        let s = q[0] * q[0] + q[1] * q[1];
        let pull = self.weights[0][0] * s * (s - 1.0) * (s - 1.0) + self.weights[1][2] * q[0];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - pull
    }

    fn rayleigh(&self, v: [f32; 2]) -> f32 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}

dalembert_c::c_api! { ring: Ring, rule: Midpoint }

dalembert_c::parameters! {
    /// A pendulum whose gravity swells and ebbs, with two inputs.
    pub struct Winch {
        /// Drag.
        pub c: f64,
        /// Amplitude of the swell.
        pub a: f64,
    }
}

#[rayleigh_system(rule = gauss, parameters = [c, a])]
impl Winch {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * v[0] * v[0] + (1.0 + self.a * (3.0 * t).sin()) * q[0].cos()
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.c * v[0] * v[0]
    }

    fn force(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 2], t: f64) -> [f64; 1] {
        [u[0] * q[0].cos() + u[1] * t.cos()]
    }
}

dalembert_c::c_api! { winch: Winch, rule: Gauss<2> }

dalembert_c::parameters! {
    /// A swing that is pushed by the clock.
    pub struct Swing {
        /// Drag.
        pub c: f64,
    }
}

#[rayleigh_system(rule = trapezoidal)]
impl Swing {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos() + 0.1 * t.sin() * q[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.c * v[0] * v[0]
    }
}

dalembert_c::c_api! { swing: Swing, rule: Trapezoidal }
