//! num-dual needs std.

use dalembert_macros::rayleigh_system_core as rayleigh_system;

struct Free;

#[rayleigh_system(derivatives = num_dual)]
impl Free {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }
}

fn main() {}
