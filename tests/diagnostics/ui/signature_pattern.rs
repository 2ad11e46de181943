use dalembert::rayleigh_system;

struct System;

#[rayleigh_system]
impl System {
    fn lagrangian(&self, [q0, q1]: [f64; 2], v: [f64; 2]) -> f64 {
        v[0] * v[1] - q0 * Self::product((q1, q0))
    }
    fn product((a, b): (f64, f64)) -> f64 {
        a * b
    }
}

#[rayleigh_system]
fn function(q: [f64; 1], v: [f64; 1], (m, k): (f64, f64)) -> f64 {
    m * v[0] - k * q[0]
}

fn main() {}
