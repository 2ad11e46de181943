//! A system that takes an input, handed to the checkers and to joint rules without it.

use dalembert::rayleigh::structure;
use dalembert::samples::Segment;
use dalembert::{Discrete, Discretise, Fitted, Midpoint, OneSided, rayleigh_system};

struct Cart {
    m: f64,
    r: f64,
}

#[rayleigh_system(rule = [midpoint, fitted, one_sided])]
impl Cart {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
}

fn one_sided(_: &impl Discrete<OneSided, 1>) {}
fn fitted(_: &impl Discrete<Fitted, 1>) {}

fn main() {
    let cart = Cart { m: 1.0, r: 0.1 };
    let segments = [Segment::new([0.0], [0.1])];
    let _ = cart.by(Midpoint, 0.1).noether();
    let _ = cart.by(Midpoint, 0.1).hamilton_jacobi();
    let _ = structure(&cart, Midpoint, 0.1, &segments);
    one_sided(&cart);
    fitted(&cart);
}
