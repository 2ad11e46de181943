use dalembert::rayleigh_system;

trait Curve: Sized {
    fn curve(self) -> f64;
    fn bent(&self, by: f64) -> f64;
    fn len(&self) -> f64;
}

impl Curve for f64 {
    fn curve(self) -> f64 {
        self * self
    }
    fn bent(&self, by: f64) -> f64 {
        self + by
    }
    fn len(&self) -> f64 {
        self.abs()
    }
}

struct System { k: f64 }

#[rayleigh_system(derivatives = num_dual)]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let height: f64 = q.iter().map(|x| x.bent(self.k)).sum();
        let ([x, _], (y, _)) = (q, (v[1], 0.5));
        0.5 * v[0] * v[0].len() + x.len() - y.len() - self.k.curve() * q[0].curve() - height
    }
}

fn main() {}
