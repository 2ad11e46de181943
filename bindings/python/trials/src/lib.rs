//! Systems that misbehave.

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

dalembert_python::module!(dalembert_trials { Cut, Edited });
