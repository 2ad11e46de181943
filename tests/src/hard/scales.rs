//! One motion in coordinates whose units differ by 24 decades.

use dalembert::{State, rayleigh_system};

/// Units of the coordinates, powers of 2 next to 1e-12, 1 and 1e12: scaling by them rounds nothing.
pub const UNITS: [f64; 3] = [1.0 / (1_u64 << 40) as f64, 1.0, (1_u64 << 40) as f64];

/// Three coupled pendulums, coordinate i measured in units of `units[i]`.
#[derive(Clone, Copy, Debug)]
pub struct Scaled {
    /// What one unit of each coordinate is.
    pub units: [f64; 3],
    /// Coefficient of the friction.
    pub r: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Scaled {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let u = self.units;
        let (x, y, z) = (q[0] * u[0], q[1] * u[1], q[2] * u[2]);
        let (a, b, c) = (v[0] * u[0], v[1] * u[1], v[2] * u[2]);
        0.5 * (1.9 * a * a + 0.7 * b * b + 1.3 * c * c)
            + 0.4 * a * b * (x - y).cos()
            + 3.9 * x.cos()
            + 1.5 * y.cos()
            - 0.8 * (z - x) * (z - x)
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        let u = self.units;
        let (a, b, c) = (v[0] * u[0], v[1] * u[1], v[2] * u[2]);
        0.5 * self.r * (a * a + (b - a) * (b - a) + c * c)
    }
}

impl Scaled {
    /// A state given in plain units.
    pub fn state(&self, q: [f64; 3], p: [f64; 3]) -> State<f64, 3> {
        let u = self.units;
        State {
            q: std::array::from_fn(|i| q[i] / u[i]).into(),
            p: std::array::from_fn(|i| p[i] * u[i]).into(),
        }
    }

    /// A state in plain units.
    pub fn plain(&self, state: &State<f64, 3>) -> State<f64, 3> {
        let u = self.units;
        State {
            q: std::array::from_fn(|i| state.q[i] * u[i]).into(),
            p: std::array::from_fn(|i| state.p[i] / u[i]).into(),
        }
    }
}
