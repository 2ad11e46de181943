use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.height(q[0]) * v[0]
    }
    fn height(&self, x: f64) -> f64 {
        x * self.k
    }
    fn height_over(&self, x: f64) -> f64 {
        x
    }
}

fn main() {}
