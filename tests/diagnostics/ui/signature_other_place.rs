//! Arguments go by their place: a name that is known for another one is told, and a number after v is the
//! time only if it is called so.

use dalembert::rayleigh_system;

struct Swapped;

#[rayleigh_system]
impl Swapped {
    fn lagrangian(&self, v: [f64; 1], q: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn rayleigh(&self, q: [f64; 1]) -> f64 {
        0.5 * q[0] * q[0]
    }
    fn force(&self, v: [f64; 1], _u: [f64; 1]) -> [f64; 1] {
        [-v[0]]
    }
}

struct Pushed;

#[rayleigh_system]
impl Pushed {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: f64) -> [f64; 1] {
        [u]
    }
}

struct Damped;

#[rayleigh_system]
impl Damped {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1], mass: f64) -> f64 {
        0.5 * mass * v[0] * v[0]
    }
    fn rayleigh(&self, v: [f64; 1], c: f64) -> f64 {
        0.5 * c * v[0] * v[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: [f64; 1]) -> [f64; 1] {
        t
    }
}

struct Loaded;

#[rayleigh_system]
impl Loaded {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1], _: f64) -> f64 {
        0.5 * v[0] * v[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], force: f64) -> [f64; 1] {
        [force]
    }
}

struct Scaled;

#[rayleigh_system]
impl Scaled {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }
    fn time_scale(&self, v: [f64; 1]) -> f64 {
        1.0 + v[0] * v[0]
    }
}

#[rayleigh_system]
fn shaken(q: [f64; 1], v: [f64; 1], t: f64, u: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * (t + u[0])
}

// A number may be called u, as a speed is.
#[rayleigh_system]
fn drawn(_q: [f64; 1], v: [f64; 1], u: f64) -> f64 {
    0.5 * (v[0] - u).powi(2)
}

#[rayleigh_system]
fn turned(v: [f64; 1], q: [f64; 1]) -> (f64, f64) {
    (0.5 * v[0] * v[0] - q[0], 0.0)
}

// Whatever else they are called, arguments go by their place.
struct Named;

#[rayleigh_system]
impl Named {
    fn lagrangian(&self, angle: [f64; 1], rate: [f64; 1], _t: f64) -> f64 {
        0.5 * rate[0] * rate[0] - angle[0]
    }
    fn force(&self, _angle: [f64; 1], _: [f64; 1], torque: [f64; 1], time: f64) -> [f64; 1] {
        [torque[0] * time]
    }
}

fn main() {}
