use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.k * sin(q[0]) - max(v[0], v[1]) + q.map(cos)[0]
    }
}

fn main() {}
