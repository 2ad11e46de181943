//! Systems of every kind that the solver and the memories tell apart, beside those that all packages share.

use std::cell::Cell;

use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::rules::{DisplacementRule, Fused};
use dalembert::run::VelocityHistory;
use dalembert::step::{Momenta, Segment, StepKernel};
use dalembert::system::{ActingForce, Derivatives};
use dalembert::{Lagrangian, Midpoint, rayleigh_system};

/// A pendulum with smoothed dry friction and cubic drag.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, one_sided])]
pub fn rubbing(q: [f64; 1], v: [f64; 1], m: f64, r: f64, e: f64, c: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] + q[0].cos(), r * (v[0] * v[0] + e * e).sqrt() + c * v[0].abs().powi(3) / 3.0)
}

/// The ring of any height: explicit by the trapezoidal rule.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal])]
pub fn ring(q: [f64; 2], v: [f64; 2], a: f64, k: f64) -> (f64, f64) {
    let s = q[0] * q[0] + q[1] * q[1];
    (0.5 * (v[0] * v[0] + v[1] * v[1]) - a * s * (s - 1.0) * (s - 1.0), 0.5 * k * (v[0] * v[0] + v[1] * v[1]))
}

/// A dense matrix that depends on q, kept from step to step.
#[rayleigh_system(rule = [midpoint, gauss])]
pub fn coupled(q: [f64; 3], v: [f64; 3], m: f64, a: f64, r: f64) -> (f64, f64) {
    let sum = v[0] + v[1] + v[2];
    let kinetic = 0.5 * m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + 0.5 * (1.0 + q[0] * q[0]) * sum * sum;
    (kinetic - a * (q[0] * q[1] * q[2]).cos(), 0.5 * r * sum * sum)
}

/// Not quadratic in v, with a domain, and a force without a derivative at 0.
#[rayleigh_system(rule = [midpoint, gauss])]
pub fn relativistic(q: [f64; 1], v: [f64; 1], m: f64, k: f64) -> f64 {
    -m * (1.0 - v[0] * v[0]).sqrt() - k * q[0].abs().powf(1.5)
}

/// By dual numbers.
#[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = num_dual)]
pub fn by_dual_numbers(q: [f64; 2], v: [f64; 2], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * (v[0] * v[0] + (1.0 + q[0] * q[0]) * v[1] * v[1]) - (k * q[1]).cosh(), r * v[0].powi(4))
}

/// No kinetic energy of the second coordinate.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn degenerate(q: [f64; 2], v: [f64; 2], m: f64) -> f64 {
    0.5 * m * v[0] * v[0] + q[0] * v[1] - q[1] * q[1]
}

/// In single precision.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn single(q: [f32; 2], v: [f32; 2], m: f32, r: f32) -> (f32, f32) {
    (0.5 * m * v[0] * v[0] + 0.5 * v[1] * v[1] - (q[0] - q[1]).powi(4), 0.5 * r * v[0] * v[0])
}

/// With an input and the time.
pub struct Cart {
    pub m: f64,
    pub c: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Cart {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * self.m * v[0] * v[0] - 0.5 * q[0] * q[0] * (1.0 + t.sin())
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.25 * self.c * v[0].powi(4)
    }

    fn force(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        [u[0] * q[0].cos()]
    }
}

thread_local! {
    static EVALUATIONS: Cell<u32> = const { Cell::new(0) };
}

/// Written by hand; counts its evaluations.
pub struct Counted {
    pub m: f64,
    pub a: f64,
    pub c: f64,
}

impl Counted {
    /// Evaluations since the last call.
    pub fn evaluations() -> u32 {
        EVALUATIONS.replace(0)
    }
}

impl Lagrangian<1> for Counted {
    type Scalar = f64;

    /// ½m v² − ¼a q⁴ + c v⁴ q
    fn lagrangian(&self, q: &SVector<f64, 1>, v: &SVector<f64, 1>) -> f64 {
        0.5 * self.m * v[0] * v[0] - 0.25 * self.a * q[0].powi(4) + self.c * v[0].powi(4) * q[0]
    }

    fn lagrangian_derivatives(&self, q: &SVector<f64, 1>, v: &SVector<f64, 1>) -> Derivatives<f64, 1> {
        EVALUATIONS.set(EVALUATIONS.get() + 1);
        let (q0, v0) = (q[0], v[0]);
        Derivatives {
            value: self.lagrangian(q, v),
            d1: [-self.a * q0.powi(3) + self.c * v0.powi(4)].into(),
            d2: [self.m * v0 + 4.0 * self.c * v0.powi(3) * q0].into(),
            d11: [[-3.0 * self.a * q0 * q0]].into(),
            d12: [[4.0 * self.c * v0.powi(3)]].into(),
            d22: [[self.m + 12.0 * self.c * v0 * v0 * q0]].into(),
        }
    }
}

impl ActingForce<1> for Counted {}

impl Fused<Midpoint, 1> for Counted {
    type Matrix = SMatrix<f64, 1, 1>;
    type Memory = VelocityHistory<f64, 1>;
    type Border = dalembert::step::Free;

    fn step_kernel(&self, segment: &Segment<f64, 1>) -> StepKernel<f64, 1> {
        Midpoint::lagrangian_kernel(self, segment)
    }

    fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
        Midpoint::lagrangian_momenta(self, segment)
    }
}
