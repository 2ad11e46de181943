//! The ring of J. E. Marsden and M. West (2001), example 3.2.3, with drag: L = ½|v|² − s(s − 1)², s = |q|².

use dalembert::rayleigh_system;

crate::parameters! {
    /// A particle of unit mass in the plane, in the potential s(s − 1)², s = |q|². Dimensionless.
    pub struct Ring {
        /// Drag coefficient.
        pub k: f64,
    }
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], lanes = explicit)]
impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0) * (s - 1.0)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}
