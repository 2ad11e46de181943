use dalembert::rayleigh_system;

#[rayleigh_system]
fn integers(q: [i32; 1], v: [i32; 1]) -> f64 {
    0.0
}

fn main() {}
