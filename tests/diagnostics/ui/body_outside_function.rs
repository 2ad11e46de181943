use dalembert::rayleigh_system;

fn square(x: f64) -> f64 {
    x * x
}

mod libm {
    pub fn sin(x: f64) -> f64 {
        x.sin()
    }
}

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        square(q[0]) + libm::sin(v[0]) + v.map(square)[1] * self.k
    }
}

fn main() {}
