use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system(rules = midpoint)]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        v[0] * v[0] - self.k * q[1]
    }
}

fn main() {
    use dalembert::nalgebra::vector;
    use dalembert::{Discretise, Midpoint, State};
    let state = State { q: vector![0.0, 0.0], p: vector![0.0, 0.0] };
    let _ = System { k: 1.0 }.by(Midpoint, 0.1).step(&state);
}
