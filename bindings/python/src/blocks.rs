//! Blocks that dry friction brings to rest: kinks of R.

use dalembert::rayleigh_system;

crate::parameters! {
    /// Three blocks in a row between two walls, joined by springs, on a floor with dry and viscous friction;
    /// q are their displacements in m.
    pub struct Blocks {
        /// Masses, kg.
        pub m: [f64; 3],
        /// Stiffness of the springs, from wall to wall, N/m.
        pub k: [f64; 4],
        /// Dry friction, N.
        pub mu: [f64; 3],
        /// Viscous friction, N s/m.
        pub c: f64,
    }
}

#[rayleigh_system(rule = proximal)]
#[allow(clippy::needless_range_loop, reason = "indices as in the formula")]
impl Blocks {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let mut sum = -0.5 * self.k[0] * q[0] * q[0] - 0.5 * self.k[3] * q[2] * q[2];
        for i in 0..3 {
            sum += 0.5 * self.m[i] * v[i] * v[i];
        }
        for i in 1..3 {
            sum -= 0.5 * self.k[i] * (q[i] - q[i - 1]) * (q[i] - q[i - 1]);
        }
        sum
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        let mut sum = 0.0;
        for i in 0..3 {
            sum += self.mu[i] * v[i].abs() + 0.5 * self.c * v[i] * v[i];
        }
        sum
    }
}
