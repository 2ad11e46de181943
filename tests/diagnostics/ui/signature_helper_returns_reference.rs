use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let mut x = q[0];
        while x > 1.0 { x *= self.k }
        Self::first(&q) + v[0] * x
    }
    fn first(x: &[f64; 2]) -> &f64 {
        &x[0]
    }
}

fn main() {}
