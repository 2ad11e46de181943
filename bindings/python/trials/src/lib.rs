//! Systems that misbehave, and one that a page has no use for.

use dalembert::rayleigh_system;
use dalembert_python::parameters;

parameters! {
    /// A spring cut into so many pieces; of none there is no stiffness, and L panics.
    pub struct Cut {
        /// How many.
        pub pieces: u32,
    }
}

#[rayleigh_system(rule = [midpoint, trapezoidal], lanes = [explicit, midpoint])]
impl Cut {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let k = f64::from(12 / self.pieces);
        0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0]
    }
}

parameters! {
    /// A pendulum; compiled with `DALEMBERT_EDITED` in the environment, its friction is another from
    /// the speed 1 on, as if its source had been edited.
    pub struct Edited {
        /// Friction.
        pub r: f64,
    }
}

const EDIT: f64 = if option_env!("DALEMBERT_EDITED").is_some() { 0.5 } else { 0.0 };

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Edited {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }

    fn rayleigh(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        let beyond = (v[0] - 1.0).max(0.0);
        0.5 * self.r * v[0] * v[0] + EDIT * beyond * beyond * beyond
    }
}

parameters! {
    /// Two bobs in a plane on massless rods of 1 m and 0.8 m; u in N pushes the second, q are places in m.
    pub struct Rods {
        /// Masses, kg.
        pub m: [f64; 2],
    }
}

#[rayleigh_system]
impl Rods {
    fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
        let mut sum = 0.0;
        for i in 0..2 {
            sum += 0.5 * self.m[i] * (v[2 * i] * v[2 * i] + v[2 * i + 1] * v[2 * i + 1]);
            sum -= self.m[i] * 9.81 * q[2 * i + 1];
        }
        sum
    }

    fn force(&self, _q: [f64; 4], _v: [f64; 4], u: [f64; 2]) -> [f64; 4] {
        [0.0, 0.0, u[0], u[1]]
    }

    fn constraints(&self, q: [f64; 4]) -> [f64; 2] {
        let (x, y) = (q[2] - q[0], q[3] - q[1]);
        [(q[0] * q[0] + q[1] * q[1]).sqrt() - 1.0, (x * x + y * y).sqrt() - 0.8]
    }
}

parameters! {
    /// A skate on a slope; q are its place in m and its direction.
    pub struct Skate {
        /// Acceleration along the slope, m/s².
        pub a: f64,
    }
}

#[rayleigh_system]
impl Skate {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + self.a * q[0]
    }

    fn velocity_constraints(&self, q: [f64; 3], v: [f64; 3]) -> [f64; 1] {
        [q[2].sin() * v[0] - q[2].cos() * v[1]]
    }
}

parameters! {
    /// A mass on a spring that ends in a dashpot; q are both ends in m.
    pub struct Maxwell {
        /// Masses of both, kg.
        pub m: [f64; 2],
        /// Stiffness, N/m.
        pub k: f64,
        /// Damping, N s/m.
        pub c: f64,
    }
}

#[rayleigh_system(rule = [midpoint, gauss])]
impl Maxwell {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let kinetic = 0.5 * (self.m[0] * v[0] * v[0] + self.m[1] * v[1] * v[1]);
        kinetic - 0.5 * self.k * (q[0] - q[1]).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.c * v[1] * v[1]
    }
}

dalembert_python::module!(
    /// Systems that misbehave, for tests.
    dalembert_trials { Cut, Edited, Rods, Skate, Maxwell }
);
