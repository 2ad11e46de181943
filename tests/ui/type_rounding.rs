use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        q[0].floor() * v[0].round() * self.k + q.map(f64::fract)[0] + v[1].rem_euclid(2.0)
    }
}

fn main() {}
