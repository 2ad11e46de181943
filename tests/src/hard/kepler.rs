//! The Kepler problem, on orbits that almost collide.

use dalembert::{State, rayleigh_system};

/// L = ½|v|² + 1/|q|, R = ½k|v|²: at `e` → 1 the distance falls to 1 − e, where the force is (1 − e)⁻².
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal])]
pub fn kepler(q: [f64; 2], v: [f64; 2], k: f64) -> (f64, f64) {
    let speed = v[0] * v[0] + v[1] * v[1];
    (0.5 * speed + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt(), 0.5 * k * speed)
}

impl Kepler {
    /// At the far end of the orbit with semi-major axis 1: the period is 2π, E = −½, J = √(1 − e²).
    pub fn aphelion(e: f64) -> State<f64, 2> {
        State { q: [1.0 + e, 0.0].into(), p: [0.0, ((1.0 - e) / (1.0 + e)).sqrt()].into() }
    }

    /// E = ½|p|² − 1/|q|.
    pub fn energy_of(state: &State<f64, 2>) -> f64 {
        0.5 * state.p.norm_squared() - 1.0 / state.q.norm()
    }

    /// J = q × p; with drag J(t) = J(0) e^{−kt}.
    pub fn angular_momentum(state: &State<f64, 2>) -> f64 {
        state.q.perp(&state.p)
    }
}

/// Kepler's problem in τ, dt = |q|^{3/2} dτ, on orbits of energy `e`: σ (L(q, w/σ) + E), w = dq/dτ, the same
/// p.
#[rayleigh_system(rule = gauss)]
pub fn kepler_of_energy(q: [f64; 2], w: [f64; 2], e: f64) -> f64 {
    let r = (q[0] * q[0] + q[1] * q[1]).sqrt();
    let scale = r * r.sqrt();
    0.5 * (w[0] * w[0] + w[1] * w[1]) / scale + scale * (1.0 / r + e)
}

/// The same with a time scale: of steps equal in τ, dt = |q|^{3/2} dτ, an orbit needs some 2√2
/// arsinh(π/δ)/Δτ, δ² = 2(1 − e): more than a circle by a logarithm.
pub struct EccentricKepler {
    /// Drag.
    pub k: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
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
