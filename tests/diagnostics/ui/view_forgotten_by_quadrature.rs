//! A system that takes an input, without it, by a rule that needs nothing generated but L and the forces.

use dalembert::rules::Quadrature;
use dalembert::{Discretise, Midpoint, rayleigh_system};

struct Cart;

#[rayleigh_system]
impl Cart {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
}

fn main() {
    let _ = Cart.driven([0.0]).by(Quadrature(Midpoint), 0.1);
    let _ = Cart.by(Quadrature(Midpoint), 0.1);
}
