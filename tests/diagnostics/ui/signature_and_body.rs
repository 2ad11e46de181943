use dalembert::rayleigh_system;

struct System;

#[rayleigh_system]
impl System {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        println!("{}", q[0]);
        [v[0] * v[0] - Self::height(q[0], &mut 0.0)]
    }
    fn height(x: f64, slope: &mut f64) -> f64 {
        outside(x)
    }
}

fn outside(x: f64) -> f64 {
    x
}

fn main() {}
