//! Rules fitted to damping take no input: said at the rule, before a view could be forgotten.

use dalembert::rayleigh_system;

struct Cart {
    m: f64,
    r: f64,
}

#[rayleigh_system(rule = [midpoint, fitted, fitted_trapezoidal])]
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

fn main() {
    let cart = Cart { m: 1.0, r: 0.1 };
    let _ = cart.driven([0.0]);
}
