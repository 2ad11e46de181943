use dalembert::rayleigh_system;

struct System;

trait Mechanics {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64;
}

#[rayleigh_system]
impl Mechanics for System {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        v[0] * v[0] - q[0]
    }
}

fn main() {}
