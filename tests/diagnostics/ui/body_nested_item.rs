use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        fn square(x: f64) -> f64 {
            x * x
        }
        self.k * v[0] * q[0]
    }
}

fn main() {}
