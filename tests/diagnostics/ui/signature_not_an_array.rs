use dalembert::rayleigh_system;

type Vector = [f64; 2];

struct Alias;

#[rayleigh_system]
impl Alias {
    fn lagrangian(&self, q: Vector, v: Vector) -> f64 {
        v[0] * v[0] - q[0]
    }
}

struct Slice;

#[rayleigh_system]
impl Slice {
    fn lagrangian(&self, q: [f64; 1], v: &[f64]) -> f64 {
        v[0] * v[0] - q[0]
    }
}

#[rayleigh_system]
fn number(q: f64, v: f64) -> f64 {
    v * v - q
}

fn main() {}
