use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        q[0].floor() * v[0].round() * self.k + q.map(f64::fract)[0] + f64::rem_euclid(v[1], 2.0)
    }
}

fn main() {}
