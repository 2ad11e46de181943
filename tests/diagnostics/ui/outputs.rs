//! Outputs whose signatures are others, and that are asked for and not there.

use dalembert::rayleigh_system;
use dalembert::system::OutputFunctions;

struct OneNumber;

#[rayleigh_system]
impl OneNumber {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn outputs(&self, q: [f64; 1], _v: [f64; 1]) -> f64 {
        q[0]
    }
}

struct WithoutVelocity;

#[rayleigh_system]
impl WithoutVelocity {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
    fn outputs(&self, q: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        [q[0] - u[0]]
    }
}

struct WithoutInput;

#[rayleigh_system]
impl WithoutInput {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn outputs(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 2]) -> [f64; 1] {
        [q[0] - u[0]]
    }
}

struct OtherInput;

#[rayleigh_system]
impl OtherInput {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
    fn outputs(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 2]) -> [f64; 1] {
        [q[0] - u[0]]
    }
}

struct NoArray;

#[rayleigh_system]
impl NoArray {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: f64) -> [f64; 1] {
        [u]
    }
    fn outputs(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f32; 1] {
        [(q[0] - u[0]) as f32]
    }
}

struct WithoutOutputs;

#[rayleigh_system]
impl WithoutOutputs {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
}

fn main() {
    let _: [f64; 1] = OutputFunctions::<1, 1>::outputs(&WithoutOutputs, &[0.0].into(), &[0.0].into());
}
