use dalembert::rayleigh_system;

struct System { k: f64, c: [f64; 2] }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.k = 2.0;
        self.k += q[0];
        self.c[0] -= v[0];
        self.k
    }
}

fn main() {}
