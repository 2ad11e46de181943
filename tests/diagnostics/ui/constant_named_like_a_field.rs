#![allow(non_upper_case_globals)]

use dalembert::rayleigh_system;

const g: f64 = 9.81;
static damping: f64 = 0.1;

struct System { g: f64, damping: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - g * self.g * q[0] * q[0] * self.g
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.damping * v[0] * v[0] * self.damping
    }
}

fn main() {}
