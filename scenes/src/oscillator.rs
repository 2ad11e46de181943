//! The damped harmonic oscillator, m q̈ + r q̇ + k q = 0.

/// L = ½m v² − ½k q², R = ½r v².
#[dalembert::rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal, one_sided])]
#[must_use]
pub fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}
