use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        match q[0] {
            0.0 => self.k,
            1.0..2.0 => v[0],
            x => x,
        }
    }
}

fn main() {}
