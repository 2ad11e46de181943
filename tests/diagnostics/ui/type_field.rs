use dalembert::rayleigh_system;

struct System { k: f64, name: String }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.k * v[0] - q[0] * self.name.len() as f64
    }
}

fn main() {}
