//! Parameters that are none are told beside the other mistakes of the item, one compile for all.

use dalembert::rayleigh_system;

struct Arm {
    m: f64,
    k: f64,
}

#[rayleigh_system(rule = midpoint, parameters = [mass, k], lanes = explicit)]
impl Arm {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.m * v[0] * v[0] - 0.5 * self.k * q[0].round()
    }
}

struct Mast {
    m: f64,
}

#[rayleigh_system(rule = trapezoidal, parameters = mass, lanes = explicit)]
impl Mast {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0] * q[0]
    }
}

struct Cart {
    m: f64,
}

#[rayleigh_system(parameters(m), rule = gaus, parameters = [mass], , lanes = none)]
impl Cart {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.m * v[0] * v[0] - 0.5 * q[0].round()
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        v[0] - q[0]
    }
}

#[rayleigh_system(rule = fitted, derivatives = num_dual)]
fn slider(q: [f64; 1], v: [f64; 1]) -> (f64, f64) {
    (0.5 * v[0] * v[0] - q[0].floor(), 0.5 * v[0] * v[0])
}

fn main() {}
