use dalembert::rayleigh_system;

enum Law { Off, Linear(f64) }
struct System { law: Law, k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let mut x = q[0];
        while x > 1.0 {
            x *= self.k;
        }
        match self.law {
            Law::Off => x,
            Law::Linear(c) => c * x * v[0],
        }
    }
}

fn main() {}
