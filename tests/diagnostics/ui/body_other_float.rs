use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let x: f32 = 0.5;
        let y = q[0] as f32;
        self.k * v[0]
    }
}

fn main() {}
