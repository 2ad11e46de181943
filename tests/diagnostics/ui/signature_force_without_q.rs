//! A force takes q and v before its input: one that leaves one of them out is told its signature.

use dalembert::rayleigh_system;

struct Arm;

#[rayleigh_system]
impl Arm {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[0]
    }

    fn rayleigh(&self, v: [f64; 2], u: [f64; 1]) -> f64 {
        v[0] * v[0] * u[0]
    }

    fn force(&self, v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
        [u[0] - v[0], 0.0]
    }
}

struct Cart;

#[rayleigh_system]
impl Cart {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }

    fn force(v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        [u[0] - v[0]]
    }
}

struct Mast;

#[rayleigh_system]
impl Mast {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[0]
    }

    fn force(&self, q: [f64; 2], wind: [f64; 3], t: f64) -> [f64; 2] {
        [wind[0] * q[0] * t, 0.0]
    }
}

fn main() {}
