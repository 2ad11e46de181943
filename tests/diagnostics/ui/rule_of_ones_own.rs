use dalembert::rules::{DisplacementRule, Node, Quadrature};
use dalembert::{Composition, Discretise, State, rayleigh_system};

#[derive(Clone, Copy)]
struct Simpson;

impl DisplacementRule for Simpson {
    const NODES: &'static [Node] = &[
        Node { position: 0.0, weight: 1.0 / 6.0 },
        Node { position: 0.5, weight: 2.0 / 3.0 },
        Node { position: 1.0, weight: 1.0 / 6.0 },
    ];
}

#[rayleigh_system]
fn spring(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
}

#[rayleigh_system(rule = Simpson)]
fn listed(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
}

fn main() {
    let start = State::from_velocity(&Spring {}, [0.0], [1.0]).unwrap();
    let _ = Spring {}.by(Quadrature(Simpson), 0.1).step(&start);
    let _ = Spring {}.by(Simpson, 0.1);
    let _ = Composition::kahan_li_6(Quadrature(Simpson));
}
