use dalembert::rayleigh_system;

#[rayleigh_system]
fn integers(q: [i32; 1], v: [i32; 1]) -> f64 {
    (q[0] + v[0]) as f64
}

fn main() {}
