use dalembert::rayleigh_system;

struct Few;

#[rayleigh_system]
impl Few {
    fn lagrangian(&self, v: [f64; 1]) -> f64 {
        v[0] * v[0]
    }
}

struct Many;

#[rayleigh_system]
impl Many {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        v[0] * v[0] - q[0]
    }
    fn rayleigh(&self) -> f64 {
        1.0
    }
    fn force(&self, q: [f64; 1]) -> [f64; 1] {
        q
    }
}

#[rayleigh_system]
fn function(q: [f64; 1]) -> f64 {
    q[0]
}

fn main() {}
