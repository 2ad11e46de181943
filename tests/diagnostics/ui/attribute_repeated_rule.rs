use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system(rule = [midpoint, trapezoidal, midpoint])]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        v[0] * v[0] - self.k * q[1]
    }
}

fn main() {}
