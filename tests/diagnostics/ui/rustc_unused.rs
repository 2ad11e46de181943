#![deny(warnings)]
use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let x = q[0];
        let mut y = v[0];
        self.k * y
    }
}

fn main() {}
