//! A length from outside the block: dual numbers make the derivatives, and say so.
#![deny(warnings)]

use dalembert::rayleigh_system;

const N: usize = 3;

pub struct Chain {
    pub k: f64,
}

#[rayleigh_system]
impl Chain {
    fn lagrangian(&self, q: [f64; N], v: [f64; N]) -> f64 {
        let mut l = 0.0;
        for i in 0..N {
            l += 0.5 * v[i] * v[i] - self.k * q[i].cos();
        }
        l
    }
}

/// The same, allowed.
pub struct Quiet {
    pub k: f64,
}

#[allow(deprecated)]
#[rayleigh_system]
impl Quiet {
    fn lagrangian(&self, q: [f64; N], v: [f64; N]) -> f64 {
        0.5 * v[0] * v[1] * v[2] - self.k * q[0]
    }
}

/// The same, asked for.
pub struct Meant {
    pub k: f64,
}

#[rayleigh_system(derivatives = num_dual)]
impl Meant {
    fn lagrangian(&self, q: [f64; N], v: [f64; N]) -> f64 {
        0.5 * v[0] * v[1] * v[2] - self.k * q[0]
    }
}

fn main() {}
