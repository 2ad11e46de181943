//! A bob on a sphere: three coordinates and a constraint, without angles and their poles.

use dalembert::rayleigh_system;

crate::parameters! {
    /// A bob on a massless rod, hinged at the origin, in air; q = (x, y, z) in m, z upwards.
    pub struct SphericalPendulum {
        /// Mass, kg.
        pub m: f64,
        /// Length of the rod, m.
        pub l: f64,
        /// Gravity, m/s².
        pub g: f64,
        /// Drag of the air, N s/m.
        pub c: f64,
    }
}

#[rayleigh_system(rule = [midpoint, trapezoidal], parameters = [m, l, c])]
impl SphericalPendulum {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * self.m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - self.m * self.g * q[2]
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.5 * self.c * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    }

    fn constraints(&self, q: [f64; 3]) -> [f64; 1] {
        [(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]).sqrt() - self.l]
    }
}
