use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let angle = q[0] % 6.28;
        let mut x = v[0];
        x %= q[1];
        self.k * angle * x
    }
}

fn main() {}
