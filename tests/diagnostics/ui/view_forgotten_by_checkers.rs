//! A system that takes an input, handed to the checkers without it.

use dalembert::rayleigh::structure;
use dalembert::samples::Pair;
use dalembert::{Discretise, Midpoint, rayleigh_system};

struct Cart {
    m: f64,
}

#[rayleigh_system]
impl Cart {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
}

fn main() {
    let cart = Cart { m: 1.0 };
    let segments = [Pair::new([0.0], [0.1])];
    let _ = cart.by(Midpoint, 0.1).noether();
    let _ = cart.by(Midpoint, 0.1).hamilton_jacobi();
    let _ = structure(&cart, Midpoint, 0.1, &segments);
}
