use dalembert::nalgebra::vector;
use dalembert::{Discretise, Gauss, rayleigh_system};

#[rayleigh_system(rule = gauss)]
fn spring(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
}

fn main() {
    let (q0, q1) = (vector![0.0], vector![0.1]);
    let by = Spring {}.by(Gauss::<2>, 0.1);
    let _ = by.segment(&q0, &q1).unwrap().discrete_lagrangian();
    let _ = by.discrete_lagrangian(&q0, &q1);
}
