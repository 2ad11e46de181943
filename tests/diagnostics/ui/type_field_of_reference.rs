use dalembert::rayleigh_system;

struct System<'a> {
    k: &'a f64,
}

#[rayleigh_system]
impl System<'_> {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        v[0] * v[0] - self.k * q[0]
    }
}

fn main() {}
