use dalembert::rayleigh_system;

struct System {
    k: f64,
}

impl System {
    fn height(&self, x: f64) -> f64 {
        self.k * x
    }
}

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        v[0] * v[0] - self.height(q[0])
    }
}

fn main() {
    let _ = System { k: 1.0 }.height(0.0);
}
