use dalembert::rayleigh_system;

struct System<T>(T);

#[rayleigh_system]
impl<T> System<T> {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        v[0] * v[0] - q[0]
    }
}

fn main() {}
