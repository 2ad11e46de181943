//! A unit of a system with a constraint, as a library that `tests/importer.py` packs: a bob on a sphere.

use dalembert::{Midpoint, rayleigh_system};

dalembert_fmu::parameters! {
    /// A bob on a rod from the origin, with drag, pushed by u along q[0].
    pub struct Spherical {
        /// Mass.
        /// Unit: kg
        pub m: f64,
        /// Length of the rod.
        /// Unit: m
        pub l: f64,
        /// Drag.
        /// Unit: N.s/m
        pub c: f64,
    }
}

#[rayleigh_system(parameters = [m, l])]
impl Spherical {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * self.m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - self.m * 9.81 * q[2]
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.5 * self.c * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    }

    fn force(&self, _q: [f64; 3], _v: [f64; 3], u: [f64; 1]) -> [f64; 3] {
        [u[0], 0.0, 0.0]
    }

    fn constraints(&self, q: [f64; 3]) -> [f64; 1] {
        [(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]).sqrt() - self.l]
    }

    /// - `y[0]` height: over the lowest point. Unit: m
    /// - `y[1]` power: of the push. Unit: W
    /// - `y[2]` frequency: of small swings. Unit: rad/s
    fn outputs(&self, q: [f64; 3], v: [f64; 3], u: [f64; 1]) -> [f64; 3] {
        [q[2] + self.l, u[0] * v[0], (9.81 / self.l).sqrt()]
    }
}

dalembert_fmu::fmu! {
    spherical: Spherical,
    rule: Midpoint,
    step_size: 0.01,
    parameters: Spherical { m: 1.3, l: 0.7, c: 0.4 },
    q: [0.42, 0.0, -0.56],
    v: [0.0, 1.0, 0.0],
}
