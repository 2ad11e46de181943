use dalembert::rayleigh_system;

#[rayleigh_system]
struct System {
    k: f64,
}

fn main() {
    let _ = System { k: 1.0 }.k;
}
