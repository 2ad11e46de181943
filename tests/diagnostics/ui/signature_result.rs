use dalembert::rayleigh_system;

struct System;

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) {
        v[0] * v[0] - q[0];
    }
    fn rayleigh(&self, v: [f64; 1]) -> [f64; 1] {
        v
    }
    fn force(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        q[0] * v[0]
    }
}

#[rayleigh_system]
fn function(q: [f64; 1], v: [f64; 1]) -> (f64, f64, f64) {
    (q[0], v[0], 0.0)
}

fn main() {}
