//! A driven oscillator: a force that depends on the time.

use dalembert::rayleigh_system;

crate::parameters! {
    /// A mass on a spring, shaken: m q̈ + r q̇ + k q = a cos ωt; q in m.
    pub struct ShakenOscillator {
        /// Mass, kg.
        pub m: f64,
        /// Stiffness, N/m.
        pub k: f64,
        /// Damping, N s/m.
        pub r: f64,
        /// Amplitude of the force, N.
        pub a: f64,
        /// Its angular frequency, rad/s.
        pub omega: f64,
    }
}

#[rayleigh_system(parameters = [m, k, r])]
impl ShakenOscillator {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0] - 0.5 * self.k * q[0] * q[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [self.a * (self.omega * t).cos()]
    }

    /// The force, at its full size again.
    fn events(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [(0.5 * self.omega * t).sin()]
    }
}
