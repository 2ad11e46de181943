//! Fields with operators and methods of their own: derivatives would be those of numbers.

use std::ops::Mul;

#[derive(Clone, Copy)]
struct Stiffness(f64);

impl Mul<f64> for Stiffness {
    type Output = f64;
    fn mul(self, other: f64) -> f64 {
        3.0 * self.0 * other
    }
}

trait Length {
    fn len(&self) -> usize;
}

impl Length for [f64; 1] {
    fn len(&self) -> usize {
        3
    }
}

struct System {
    k: Stiffness,
}

#[dalembert::rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - self.k * q[0]
    }
}

struct Other;

#[dalembert::rayleigh_system]
impl Other {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q.len() as f64 * q[0]
    }
}

struct Borrowing {
    k: &'static f64,
}

#[dalembert::rayleigh_system]
impl Borrowing {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - self.k * q[0]
    }
}

fn main() {}
