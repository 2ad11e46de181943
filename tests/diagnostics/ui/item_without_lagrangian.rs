use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn kinetic(&self, v: [f64; 2]) -> f64 {
        v[0] * self.k
    }
}

fn main() {}
