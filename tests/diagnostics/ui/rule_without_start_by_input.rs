use dalembert::nalgebra::SVector;
use dalembert::rayleigh_system;
use dalembert::rules::{DisplacementRule, Node, Quadrature};
use dalembert::step::DiscreteSecondOrder;
use dalembert::system::Hessian;

type Vector = SVector<f64, 1>;

#[derive(Clone, Copy)]
struct Simpson;

impl DisplacementRule for Simpson {
    const NODES: &'static [Node] = &[
        Node { position: 0.0, weight: 1.0 / 6.0 },
        Node { position: 0.5, weight: 2.0 / 3.0 },
        Node { position: 1.0, weight: 1.0 / 6.0 },
    ];
}

struct Arm;

#[rayleigh_system(step_derivatives = second)]
impl Arm {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
}

struct Free;

#[rayleigh_system(step_derivatives = second)]
impl Free {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }
}

impl DiscreteSecondOrder<Quadrature<Simpson>, 1, 1> for DrivenArm<'_> {
    fn momenta_along(&self, q0: &Vector, v: &Vector, h: f64, start: &Vector, end: &Vector) -> Hessian<f64, 1, 1> {
        Simpson::lagrangian_along(self, q0, v, h, [start, end]) + Simpson::force_along(self, q0, v, h, [start, end])
    }
}

// Without an input nothing is missing.
impl DiscreteSecondOrder<Quadrature<Simpson>, 1, 0> for Free {
    fn momenta_along(&self, q0: &Vector, v: &Vector, h: f64, start: &Vector, end: &Vector) -> Hessian<f64, 1, 0> {
        Simpson::lagrangian_along(self, q0, v, h, [start, end])
    }
}

fn main() {}
