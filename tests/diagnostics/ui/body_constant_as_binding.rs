#![allow(non_upper_case_globals)]
use dalembert::rayleigh_system;

const lower: usize = 3;
struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        match q.len() {
            lower => v[0],
            _ => self.k * v[1],
        }
    }
}

fn main() {}
