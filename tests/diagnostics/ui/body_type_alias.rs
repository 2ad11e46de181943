use dalembert::rayleigh_system;

type Length = f64;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let l: Length = self.k;
        let points: [Length; 2] = q;
        l * points[0] * v[0]
    }
}

fn main() {}
