use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let x: Vec<f64> = Vec::new();
        let y = x;
        q[x.len()] * v[y.len()] * self.k
    }
}

fn main() {}
