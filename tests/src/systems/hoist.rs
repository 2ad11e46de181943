//! A load on a rope of prescribed length: by its place, on a constraint in time, and by its angle.

use dalembert::rayleigh_system;

/// The length of the rope at time t, and its rate.
#[must_use]
pub fn rope(t: f64) -> [f64; 2] {
    [2.0 - 0.5 * (0.7 * t).sin(), -0.35 * (0.7 * t).cos()]
}

/// A load of 1.5 that hangs on the rope, with drag.
pub struct Hoist;

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Hoist {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.75 * (v[0] * v[0] + v[1] * v[1]) - 1.5 * 9.81 * q[1]
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.15 * (v[0] * v[0] + v[1] * v[1])
    }

    fn constraints(&self, q: [f64; 2], t: f64) -> [f64; 1] {
        let length = 2.0 - 0.5 * (0.7 * t).sin();
        [q[0] * q[0] + q[1] * q[1] - length * length]
    }
}

/// The load by its angle.
pub struct HoistByAngle;

#[rayleigh_system(rule = gauss)]
impl HoistByAngle {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        let (length, rate) = (2.0 - 0.5 * (0.7 * t).sin(), -0.35 * (0.7 * t).cos());
        0.75 * (rate * rate + length * length * v[0] * v[0]) + 1.5 * 9.81 * length * q[0].cos()
    }

    fn rayleigh(&self, v: [f64; 1], t: f64) -> f64 {
        let length = 2.0 - 0.5 * (0.7 * t).sin();
        0.15 * length * length * v[0] * v[0]
    }
}
