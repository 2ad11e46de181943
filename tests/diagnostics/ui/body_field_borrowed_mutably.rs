use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let k = &mut self.k;
        *k += q[0];
        *k * v[0]
    }
}

fn main() {}
