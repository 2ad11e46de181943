//! The mechanisms as this project steps them, but for the four-bar linkage, which `dalembert_scenes` has.

use dalembert::rayleigh_system;

/// Acceleration of gravity, m/s².
pub const G: f64 = 9.81;

/// A mass of 1 kg on a rod of 1 m about the origin, in space.
#[derive(Clone, Copy)]
pub struct SphericalPendulum {
    /// kg/s
    pub drag: f64,
}

#[rayleigh_system]
impl SphericalPendulum {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - G * q[2]
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.5 * self.drag * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    }

    fn constraints(&self, q: [f64; 3]) -> [f64; 1] {
        [0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1.0)]
    }
}

/// Masses of [`TwoRods`], kg.
pub const MASSES: [f64; 2] = [1.0, 0.7];
/// Lengths of its rods, m.
pub const LENGTHS: [f64; 2] = [1.0, 0.8];

/// A double pendulum: two masses in a plane, on rods without mass.
#[derive(Clone, Copy)]
pub struct TwoRods {}

#[rayleigh_system]
impl TwoRods {
    fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
        let mut sum = 0.0;
        for i in 0..2 {
            sum += 0.5 * MASSES[i] * (v[2 * i] * v[2 * i] + v[2 * i + 1] * v[2 * i + 1]);
            sum -= MASSES[i] * G * q[2 * i + 1];
        }
        sum
    }

    fn constraints(&self, q: [f64; 4]) -> [f64; 2] {
        let [x, y] = [q[2] - q[0], q[3] - q[1]];
        [
            0.5 * (q[0] * q[0] + q[1] * q[1] - LENGTHS[0] * LENGTHS[0]),
            0.5 * (x * x + y * y - LENGTHS[1] * LENGTHS[1]),
        ]
    }
}
