//! σ is a number, of the configuration alone; a system without it has no run that follows it.

use dalembert::{Discretise, Midpoint, State, rayleigh_system};

struct Moving;

#[rayleigh_system]
impl Moving {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn time_scale(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        q[0] + v[0]
    }
}

struct Other;

#[rayleigh_system]
impl Other {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn time_scale(q: [f64; 2]) -> [f64; 2] {
        q
    }
}

struct Without;

#[rayleigh_system]
impl Without {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
}

fn main() {
    let start = State { q: [0.0].into(), p: [0.0].into() };
    let _ = Moving.by(Midpoint, 0.1).run(start).in_scaled_time();
    let _ = Other.by(Midpoint, 0.1).run(start).in_scaled_time();
    let _ = Without.by(Midpoint, 0.1).run(start).in_scaled_time();
}
