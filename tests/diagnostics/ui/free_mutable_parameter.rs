//! A parameter that is `mut` is a field like any other, also beside a mistake.

use dalembert::rayleigh_system;

#[rayleigh_system]
fn growing(q: [f64; 1], v: [f64; 1], mut m: f64) -> f64 {
    m *= 2.0;
    0.5 * m * v[0] * v[0] - q[0].floor()
}

fn main() {
    let system = Growing { m: 1.0 };
    let _ = system.m;
}
