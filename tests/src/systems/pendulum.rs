//! The plane pendulum with viscous friction, and without.

use dalembert::rayleigh_system;

use crate::by_hand::{ByHand, Number};

/// A pendulum of mass m and length l, q the angle from the vertical: m l² q̈ = −m g l sin q − r q̇.
#[derive(Clone, Copy, Debug)]
pub struct Pendulum {
    /// Mass.
    pub m: f64,
    /// Length.
    pub l: f64,
    /// Acceleration of gravity.
    pub g: f64,
    /// Coefficient of friction.
    pub r: f64,
}

impl Pendulum {
    /// Parameters without accidental coincidences.
    pub const EXAMPLE: Self = Self { m: 1.7, l: 0.8, g: 3.1, r: 0.6 };
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Pendulum {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * self.l.powi(2) * v[0].powi(2) + self.m * self.g * self.l * q[0].cos()
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }
}

impl ByHand<1> for Pendulum {
    fn lagrangian_by_hand<D: Number>(&self, [q]: [D; 1], [v]: [D; 1]) -> D {
        v * v * (self.m * self.l * self.l / 2.0) + q.cos() * (self.m * self.g * self.l)
    }

    fn rayleigh_by_hand<D: Number>(&self, _: [D; 1], [v]: [D; 1]) -> D {
        v * v * (self.r / 2.0)
    }

    fn acceleration(&self, [q]: [f64; 1], [v]: [f64; 1]) -> [f64; 1] {
        [-self.g / self.l * q.sin() - self.r / (self.m * self.l * self.l) * v]
    }
}

/// The pendulum of mass m and length 1 without friction, as a free function.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn free_pendulum(q: [f64; 1], v: [f64; 1], m: f64, g: f64) -> f64 {
    0.5 * m * v[0] * v[0] + m * g * q[0].cos()
}

impl ByHand<1> for FreePendulum {
    fn lagrangian_by_hand<D: Number>(&self, [q]: [D; 1], [v]: [D; 1]) -> D {
        (v * v / 2.0 + q.cos() * self.g) * self.m
    }

    fn acceleration(&self, [q]: [f64; 1], _: [f64; 1]) -> [f64; 1] {
        [-self.g * q.sin()]
    }
}
