//! Without std there is no other engine than written-out derivatives.

use dalembert_macros::rayleigh_system_core as rayleigh_system;

struct Pendulum {
    turns: u32,
}

#[rayleigh_system]
impl Pendulum {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let mut energy = 0.5 * v[0] * v[0];
        for _ in 0..self.turns {
            energy += q[0].cos();
        }
        energy
    }
}

fn main() {}
