use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        assert!(q[0] > 0.0);
        let x = vec![q[0]];
        if cfg!(test) { dbg!(v[0]) } else { self.k }
    }
}

fn main() {}
