//! Systems with tables: in double and single precision, with and without time and constraints.

use dalembert::system::Table;
use dalembert::{Midpoint, rayleigh_system};

dalembert_c::parameters! {
    /// A rocket, held by a rail; q is its position in m.
    pub struct Rocket {
        /// Mass in kg.
        pub mass: f64,
        /// Thrust in N over the time in s.
        pub thrust: Table<4>,
        /// Stages, not used.
        pub stages: u8,
        /// Friction of the rail in N s/m over the position in m.
        pub rail: Table<5>,
    }
}

#[rayleigh_system(parameters = [mass])]
impl Rocket {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.mass * v[0] * v[0] - self.mass * 9.81 * q[0]
    }

    fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.rail.at(q[0]) * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [self.thrust.at(t)]
    }
}

dalembert_c::c_api! { rocket: Rocket, rule: Midpoint }

dalembert_c::parameters! {
    /// A bead on a curve, y = height(x), in single precision.
    pub struct Bead {
        /// Height over the place, both in m.
        pub height: Table<6, f32>,
    }
}

#[rayleigh_system]
impl Bead {
    fn lagrangian(&self, q: [f32; 2], v: [f32; 2]) -> f32 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 9.81 * q[1]
    }

    fn constraints(&self, q: [f32; 2]) -> [f32; 1] {
        [q[1] - self.height.at(q[0])]
    }
}

dalembert_c::c_api! { bead: Bead, rule: Midpoint }
