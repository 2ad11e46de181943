use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        Self::sum(q) + Self::sum(v) + self.k
    }
    fn sum<const M: usize>(x: [f64; M]) -> f64 {
        x.iter().sum()
    }
}

fn main() {}
