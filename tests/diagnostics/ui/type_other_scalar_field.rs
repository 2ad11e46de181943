use dalembert::rayleigh_system;

struct System { k: f64, c: f32 }

#[rayleigh_system(derivatives = num_dual)]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.k * v[0] - q[0] * self.c
    }
}

fn main() {}
