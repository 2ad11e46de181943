use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        #[cfg(not(debug_assertions))]
        let q = [2.0 * q[0]];
        q[0] * v[0] * self.k
    }
    #[cfg(any())]
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        v[0] * v[0]
    }
}

fn main() {}
