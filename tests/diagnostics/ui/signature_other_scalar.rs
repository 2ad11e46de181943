use dalembert::rayleigh_system;

struct System;

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f32; 1], v: [f64; 1]) -> f64 {
        q[0] as f64 * v[0]
    }
    fn rayleigh(&self, v: [f64; 1]) -> f32 {
        v[0] as f32
    }
}

fn main() {}
