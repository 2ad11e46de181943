//! What `rule = proximal` asks of R and of the system.

use dalembert::rayleigh_system;

struct Smooth;

#[rayleigh_system(rule = proximal)]
impl Smooth {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + v[0].abs().powi(3)
    }
}

struct Without;

#[rayleigh_system(rule = [midpoint, proximal])]
impl Without {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    }
}

struct NotLinear;

#[rayleigh_system(rule = proximal)]
impl NotLinear {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        (v[0] * v[0] - 1.0).abs()
    }
}

struct NotApart;

#[rayleigh_system(rule = proximal)]
impl NotApart {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * q[0] * q[1]
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        (1.0 + v[1] * v[1]) * v[0].abs()
    }
}

struct Nested;

#[rayleigh_system(rule = proximal)]
impl Nested {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * q[0] * q[1]
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        -(-v[0].hypot(v[1])).exp()
    }
}

struct Form;

#[rayleigh_system(rule = proximal)]
impl Form {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * q[0] * q[1]
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        (v[0] * v[0] + v[1] * v[1] + v[0] * v[1]).sqrt()
    }
}

struct Held;

#[rayleigh_system(rule = proximal)]
impl Held {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[1]
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        v[0].abs()
    }
    fn constraints(&self, q: [f64; 2]) -> [f64; 1] {
        [q[0] * q[0] + q[1] * q[1] - 1.0]
    }
    fn time_scale(&self, q: [f64; 2]) -> f64 {
        1.0 + q[0] * q[0]
    }
}

struct Dual;

#[rayleigh_system(rule = proximal, derivatives = num_dual)]
impl Dual {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        v[0].abs()
    }
}

fn main() {}
