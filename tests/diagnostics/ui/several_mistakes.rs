use dalembert::rayleigh_system;

struct System {
    k: f64,
    label: String,
}

#[rayleigh_system(rule = euler)]
impl System {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s: Length = q[0] * q[0];
        println!("{s}");
        helper(s) + v[0]
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        self.k = 1.0;
        self.drag(v[0])
    }
}

#[rayleigh_system]
fn second(q: [f64; 1], v: [f64; 1]) -> f64 {
    helper(q[0]) + v[0]
}

fn helper(x: f64) -> f64 {
    x
}

type Length = f64;

fn main() {}
