//! A rocket: a thrust and a drag that were measured, as tables.

use dalembert::rayleigh_system;
use dalembert::system::Table;

crate::parameters! {
    /// A rocket that rises in still air; q is its height in m.
    pub struct Rocket {
        /// Mass, kg.
        pub mass: f64,
        /// Thrust in N over the time in s.
        pub thrust: Table<4>,
        /// Drag in N over the speed in m/s.
        pub drag: Table<6>,
    }
}

#[rayleigh_system(rule = [midpoint, gauss], parameters = [mass], lanes = midpoint)]
impl Rocket {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.mass * v[0] * v[0] - 9.81 * self.mass * q[0]
    }

    fn force(&self, _q: [f64; 1], v: [f64; 1], t: f64) -> [f64; 1] {
        let drag = self.drag.at(v[0].abs());
        [self.thrust.at(t) - if v[0] < 0.0 { -drag } else { drag }]
    }
}
