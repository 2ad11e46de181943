use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let x = unsafe { q[0] };
        let _y = async { v[0] };
        x * self.k
    }
}

fn main() {}
