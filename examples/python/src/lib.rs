//! A pendulum, and the Python module that it is in.

#![forbid(unsafe_code)]

use dalembert::rayleigh_system;

dalembert_python::parameters! {
    /// A mass on a rod, hinged with friction; q is the angle from below in rad.
    pub struct Pendulum {
        /// Mass, kg.
        pub mass: f64,
        /// Length of the rod, m.
        pub length: f64,
        /// Friction of the hinge, N m s.
        pub friction: f64,
    }
}

#[rayleigh_system(rule = [midpoint, gauss])]
impl Pendulum {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.mass * (self.length * v[0]).powi(2) + self.mass * 9.81 * self.length * q[0].cos()
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.friction * v[0] * v[0]
    }
}

dalembert_python::module!(machines { Pendulum });
