//! Public systems, under the workspace's `deny(missing_docs)`: all that the macro makes public carries
//! documentation.

use dalembert::rayleigh_system;

/// A free particle of unit mass.
#[derive(Debug, Clone, Copy)]
pub struct Free;

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Free {
    /// L = ½ v².
    #[must_use]
    pub fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }
}

/// L and R of a damped oscillator.
#[rayleigh_system(rule = trapezoidal)]
#[must_use]
pub fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * (m * v[0] * v[0] - k * q[0] * q[0]), 0.5 * r * v[0] * v[0])
}
