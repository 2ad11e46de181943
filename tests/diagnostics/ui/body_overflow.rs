use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system(derivatives = expanded)]
impl System {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let n: u8 = 200;
        q[0] * v[0] * self.k * (n + 100) as f64
    }
}

#[rayleigh_system(derivatives = expanded)]
fn other(q: [f64; 2], v: [f64; 2]) -> f64 {
    match q[0] {
        FIRST => v[0],
        _ => v[1],
    }
}

const FIRST: f64 = 1.0;

fn main() {}
