//! Kepler's problem in the plane with a unit mass about a unit centre.

/// L = ½|v|² + 1/|q|, R = ½k|v|².
#[dalembert::rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal], lanes = [explicit, gauss])]
#[must_use]
pub fn kepler(q: [f64; 2], v: [f64; 2], k: f64) -> (f64, f64) {
    let speed = v[0] * v[0] + v[1] * v[1];
    (0.5 * speed + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt(), 0.5 * k * speed)
}

/// The same with a time scale σ = |q|^{3/2}, which for any eccentricity makes the same steps of the near side.
#[derive(Clone, Copy)]
pub struct EccentricKepler {
    /// Drag.
    pub k: f64,
}

#[dalembert::rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl EccentricKepler {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
    fn time_scale(&self, q: [f64; 2]) -> f64 {
        let r = (q[0] * q[0] + q[1] * q[1]).sqrt();
        r * r.sqrt()
    }
}
