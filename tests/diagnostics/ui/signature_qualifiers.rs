use dalembert::rayleigh_system;

struct System;

#[rayleigh_system]
impl System {
    const fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        v[0] * v[0] - q[0]
    }
    async fn rayleigh(&self, v: [f64; 1]) -> f64 {
        v[0] * v[0]
    }
    unsafe extern "C" fn force(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        [q[0] * v[0]]
    }
}

fn main() {}
