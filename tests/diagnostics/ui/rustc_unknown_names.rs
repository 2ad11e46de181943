use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let square = v[0] * v[0];
        sqare * self.kk - qq[0] + q[0].sine() + self.k
    }
}

fn main() {}
