use dalembert::nalgebra::vector;
use dalembert::{Discretise, Lagrangian, Midpoint, differentiable, rayleigh_system};

struct Empty { k: f64 }

#[rayleigh_system]
impl Empty {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {}
    fn force(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        [-self.k * q[0] * v[0].abs()];
    }
}

#[rayleigh_system(derivatives = num_dual)]
fn oscillator(q: [f64; 1], v: [f64; 1], m: f64) -> f64 {
    let kinetic = 0.5 * m * v[0] * v[0];
}

#[differentiable]
fn field(q: [f64; 1]) -> f64 {}

fn main() {
    let empty = Empty { k: 1.0 };
    let _ = empty.energy(&vector![0.0], &vector![0.0]);
    let _ = empty.by(Midpoint, 0.1);
    let _ = Oscillator { m: 1.0 }.energy(&vector![0.0], &vector![0.0]);
}
