use dalembert::rayleigh_system;
use dalembert::system::Table;

/// It has an `at`, and no derivatives.
struct Height;

impl Height {
    fn at(&self, x: f64) -> f64 {
        x * x
    }
}

struct OwnMethod {
    height: Height,
}

#[rayleigh_system]
impl OwnMethod {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - self.height.at(q[0])
    }
}

struct Number {
    k: f64,
}

#[rayleigh_system]
impl Number {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - self.k.at(q[0])
    }
}

struct TwoPlaces {
    drag: Table<4>,
}

#[rayleigh_system(derivatives = expanded)]
impl TwoPlaces {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - self.drag.at(q[0], v[0])
    }
}

fn main() {}
