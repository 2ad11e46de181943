use dalembert::nalgebra::vector;
use dalembert::{Discretise, Trapezoidal, rayleigh_system};

struct System;

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        v[0] * v[0] - q[0]
    }
}

fn main() {
    let _ = System.by(Trapezoidal, 0.1).discrete_lagrangian(&vector![0.0], &vector![1.0]);
}
