use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let Self { k } = self;
        let other = self;
        k * other.k * v[0] * { let mut x = q[0]; while x > 1.0 { x *= 0.5 } x }
    }
}

fn main() {}
