use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let i: usize = q[0];
        let mut x = v[0];
        x = true;
        self.k * x * i as f64
    }
}

fn main() {}
