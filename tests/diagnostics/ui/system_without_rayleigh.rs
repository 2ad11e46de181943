use dalembert::nalgebra::vector;
use dalembert::{Discretise, Midpoint, Rayleigh, rayleigh_system};

struct System;

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        v[0] * v[0] - q[0]
    }
}

fn main() {
    let (q, v) = (vector![0.0], vector![1.0]);
    let _ = Rayleigh::<1>::rayleigh(&System, &q, &v);
    let _ = System.by(Midpoint, 0.1).discrete_rayleigh(&q, &v);
}
