//! Rules that take L and R together say what a system lacks for them.

use dalembert::rayleigh_system;

#[rayleigh_system(rule = fitted)]
fn undamped(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system(rule = [midpoint, fitted_trapezoidal, one_sided])]
fn dry(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - q[0] * q[0], r * v[0].powi(4))
}

#[rayleigh_system(rule = [one_sided, fitted])]
fn bead(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0], r * q[0] * q[0] * v[0] * v[0])
}

#[rayleigh_system(rule = [fitted, one_sided])]
fn arm(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + v[1] * v[1] + v[0] * v[1] * (q[0] - q[1]).cos(), r * v[0] * v[0])
}

#[rayleigh_system(rule = fitted, derivatives = num_dual)]
fn by_duals(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - q[0] * q[0], r * v[0] * v[0])
}

struct Pushed;

#[rayleigh_system(rule = fitted)]
impl Pushed {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        v[0] * v[0]
    }

    fn force(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        [q[0] * v[0]]
    }
}

struct Worn {
    r: f64,
}

#[rayleigh_system(rule = [gauss, fitted, one_sided])]
impl Worn {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * v[0] * v[0] - q[0] * t
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        self.r * v[0] * v[0]
    }
}

#[rayleigh_system(rule = [gauss, fitted], parameters = r)]
fn tuned(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - q[0] * q[0], r * v[0] * v[0])
}

#[rayleigh_system(rule = one_sided)]
fn free(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system(rule = one_sided, step_derivatives = second)]
fn bent(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - q[0] * q[0], r * v[0] * v[0])
}

fn main() {}
