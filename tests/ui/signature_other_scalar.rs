use dalembert::rayleigh_system;

struct System;

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f32; 1], v: [f64; 1]) -> f64 {
        0.0
    }
    fn rayleigh(&self, v: [f64; 1]) -> f32 {
        0.0
    }
}

fn main() {}
