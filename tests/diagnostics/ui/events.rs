//! Event functions whose signatures are others, and that are asked for and not there.

use dalembert::{Discretise, Midpoint, State, rayleigh_system};

struct OneNumber;

#[rayleigh_system]
impl OneNumber {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn events(&self, q: [f64; 1], _v: [f64; 1]) -> f64 {
        q[0]
    }
}

struct WithoutVelocity;

#[rayleigh_system]
impl WithoutVelocity {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn events(&self, q: [f64; 1]) -> [f64; 1] {
        q
    }
}

struct WithInput;

#[rayleigh_system]
impl WithInput {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
    fn events(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        [q[0] - u[0]]
    }
}

struct WithoutEvents;

#[rayleigh_system]
impl WithoutEvents {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
}

fn main() {
    let start = State { q: [1.0].into(), p: [0.0].into() };
    let mut run = WithoutEvents.by(Midpoint, 0.1).run(start);
    let _ = run.watch(|at| at.events::<1>()).next();
}
