//! Two numbers for a force that takes one.

use dalembert::nalgebra::vector;
use dalembert::rayleigh_system;

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
    let _ = cart.driven([1.0]);
    let _ = cart.driven(vector![1.0]);
    let _ = cart.driven([1.0, 2.0]);
    let _ = cart.driven(vector![1.0, 2.0]);
    let _ = cart.driven(1.0);
}
