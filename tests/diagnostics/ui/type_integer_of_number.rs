use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let i = q[0] as usize;
        let n = (v[0] * 2.0) as i32;
        self.k * n as f64 * v[i]
    }
}

fn main() {}
