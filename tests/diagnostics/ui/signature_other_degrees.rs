use dalembert::rayleigh_system;

struct System;

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 3]) -> f64 {
        v[0] * v[0] - q[0]
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        v[0] * v[0]
    }
    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 4] {
        [q[0] * v[0]; 4]
    }
}

fn main() {}
