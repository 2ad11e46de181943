use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        self.slice(&q) + Self::owned(q.to_vec()) + Self::changed(&mut [0.0; 2]) + v[0]
    }
    fn slice(&self, q: &[f64]) -> f64 {
        q[0] * self.k
    }
    fn owned(q: Vec<f64>) -> f64 {
        q[0]
    }
    fn changed(q: &mut [f64; 2]) -> f64 {
        q[0]
    }
}

fn main() {}
