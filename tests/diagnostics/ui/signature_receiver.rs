use dalembert::rayleigh_system;

struct System;

#[rayleigh_system]
impl System {
    fn lagrangian(q: [f64; 1], v: [f64; 1]) -> f64 {
        v[0] * v[0] - q[0]
    }
    fn rayleigh(&mut self, v: [f64; 1]) -> f64 {
        v[0] * v[0]
    }
    fn force(self, q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        [q[0] * v[0]]
    }
}

fn main() {}
