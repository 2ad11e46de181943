//! Fused sums in a build for any x86-64 are calls, and it is said at the word; not where it is allowed, nor
//! where members are stepped in lanes.
#![deny(warnings)]

use dalembert::rayleigh_system;

#[rayleigh_system(multiply_add = fused)]
fn by_calls(q: [f64; 1], v: [f64; 1], m: f64) -> f64 {
    0.5 * m * v[0] * v[0] - q[0] * q[0]
}

#[allow(deprecated)]
#[rayleigh_system(multiply_add = fused)]
fn allowed(q: [f64; 1], v: [f64; 1], m: f64) -> f64 {
    0.5 * m * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system(rule = gauss, lanes = gauss, multiply_add = fused)]
fn in_lanes(q: [f64; 1], v: [f64; 1], m: f64) -> f64 {
    0.5 * m * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system]
fn apart(q: [f64; 1], v: [f64; 1], m: f64) -> f64 {
    0.5 * m * v[0] * v[0] - q[0] * q[0]
}

fn main() {
    let m = 1.0;
    let _ = (ByCalls { m }, Allowed { m }, InLanes { m }, Apart { m });
}
