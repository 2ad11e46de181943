//! Terms linear in v.

use dalembert::{State, rayleigh_system};

/// A unit charge in the uniform field b: L = ½|v|² + ½b(x v_y − y v_x), circles at the frequency b.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn uniform_field(q: [f64; 2], v: [f64; 2], b: f64, r: f64) -> (f64, f64) {
    let speed = v[0] * v[0] + v[1] * v[1];
    (0.5 * speed + 0.5 * b * (q[0] * v[1] - q[1] * v[0]), 0.5 * r * speed)
}

impl UniformField {
    /// At the origin with the velocity (1, 0).
    pub fn start() -> State<f64, 2> {
        State { q: [0.0, 0.0].into(), p: [1.0, 0.0].into() }
    }

    /// v = p − ½b(−y, x).
    pub fn velocity_of(&self, state: &State<f64, 2>) -> [f64; 2] {
        [state.p[0] + 0.5 * self.b * state.q[1], state.p[1] - 0.5 * self.b * state.q[0]]
    }
}
