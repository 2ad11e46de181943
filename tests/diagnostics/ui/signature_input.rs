use dalembert::{Discretise, Midpoint, State, rayleigh_system};

struct Swapped;

#[rayleigh_system]
impl Swapped {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        v[0] * v[0] - q[0]
    }
    fn force(&self, q: [f64; 1], v: [f64; 1], t: f64, u: [f64; 1]) -> [f64; 1] {
        [q[0] + v[0] + u[0] * t]
    }
}

struct Narrow;

#[rayleigh_system]
impl Narrow {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f32) -> f64 {
        v[0] * v[0] - q[0]
    }
    fn force(&self, q: [f64; 1], v: [f64; 1], u: [f32; 2], t: &f64) -> [f64; 1] {
        [q[0] + v[0]]
    }
}

struct Empty;

#[rayleigh_system]
impl Empty {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        v[0] * v[0] - q[0]
    }
    fn force(&self, q: [f64; 1], v: [f64; 1], u: [f64; 0]) -> [f64; 1] {
        [q[0] + v[0]]
    }
}

struct Elsewhere;

#[rayleigh_system]
impl Elsewhere {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], u: [f64; 2]) -> f64 {
        v[0] * v[0] - q[0] * u[0]
    }
    fn rayleigh(&self, q: [f64; 1], v: [f64; 1], u: [f64; 2]) -> f64 {
        v[0] * v[0] - q[0] * u[0]
    }
}

struct Taken;

#[rayleigh_system]
impl Taken {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        v[0] * v[0] - q[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
    fn driven(&self) {}
}

fn main() {
    // The views of systems with mistakes are there: nothing more is said.
    let state = State { q: [0.0].into(), p: [0.0].into() };
    let _ = Swapped.driven([1.0], 0.0).by(Midpoint, 0.1).step(&state);
    let _ = Empty.driven([0.0; 0]).by(Midpoint, 0.1).step(&state);
}
