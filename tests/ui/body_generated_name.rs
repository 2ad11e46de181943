use dalembert::rayleigh_system;

struct Real;
impl Real {
    const G: f64 = 9.81;
}
mod dual {
    pub const TWO: f64 = 2.0;
}

struct System { k: f64 }

#[rayleigh_system(derivatives = num_dual)]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        Real::G * q[0] + v[0] * dual::TWO * self.k
    }
}

fn main() {}
