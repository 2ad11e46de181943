use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        square(v[0]) - height(q[0])
    }
    fn square(x: f64) -> f64 {
        x * x
    }
    fn height(&self, x: f64) -> f64 {
        self.k * x
    }
}

fn main() {}
