//! The plane double pendulum: a mass matrix that depends on q.

use dalembert::rayleigh_system;

crate::parameters! {
    /// Two point masses on massless rods, one hung from the other, with friction in both joints; q are the angles from
    /// below in rad.
    pub struct DoublePendulum {
        /// Masses, kg.
        pub m: [f64; 2],
        /// Lengths, m.
        pub l: [f64; 2],
        /// Acceleration of gravity, m/s².
        pub g: f64,
        /// Friction of the joints, N m s.
        pub c: [f64; 2],
    }
}

#[rayleigh_system(rule = [midpoint, gauss], parameters = [c[0], c[1]])]
impl DoublePendulum {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [m1, m2] = self.m;
        let [l1, l2] = self.l;
        let kinetic = 0.5 * (m1 + m2) * (l1 * v[0]).powi(2)
            + 0.5 * m2 * (l2 * v[1]).powi(2)
            + m2 * l1 * l2 * v[0] * v[1] * (q[0] - q[1]).cos();
        kinetic + self.g * ((m1 + m2) * l1 * q[0].cos() + m2 * l2 * q[1].cos())
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.c[0] * v[0].powi(2) + 0.5 * self.c[1] * (v[1] - v[0]).powi(2)
    }

    /// The lower mass, at the height of the hinge; the arms, in line.
    fn events(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
        [self.l[0] * q[0].cos() + self.l[1] * q[1].cos(), (q[1] - q[0]).sin()]
    }
}
