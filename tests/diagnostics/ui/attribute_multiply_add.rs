//! What `multiply_add = fused` asks for is said at the word.

use dalembert::rayleigh_system;

#[rayleigh_system(multiply_add = separate)]
fn misspelt(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system(multiply_add = [fused, fused])]
fn several(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system(multiply_add = fused, derivatives = num_dual)]
fn by_duals(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system(multiply_add = fused)]
fn rounded(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0].floor()
}

fn main() {
    let _ = (Misspelt {}, Several {}, ByDuals {}, Rounded {});
}
