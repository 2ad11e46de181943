//! Kepler's problem in the plane with a unit mass about a unit centre.

/// L = ½|v|² + 1/|q|, R = ½k|v|².
#[dalembert::rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal], lanes = [explicit, gauss])]
#[must_use]
pub fn kepler(q: [f64; 2], v: [f64; 2], k: f64) -> (f64, f64) {
    let speed = v[0] * v[0] + v[1] * v[1];
    (0.5 * speed + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt(), 0.5 * k * speed)
}
