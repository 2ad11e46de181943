//! The ring system without the macro: what `#[rayleigh_system]` writes, with derivatives taken by hand.
//!
//! ```text
//! L = ½|v|² − V,  V = s(s − 1)²,  s = |q|²        R = ½ k |v|²
//! ∂V/∂q = 2V′ q,  ∂²V/∂q² = 2V′ I + 4V″ q qᵀ      V′ = (s − 1)(3s − 1),  V″ = 6s − 4
//! ```

use dalembert::rules::{DisplacementRule, Fused};
use dalembert::run::VelocityHistory;
use dalembert::step::{Momenta, Segment, StepKernel};
use dalembert::system::{ActingForce, Derivatives};
use dalembert::{Lagrangian, Midpoint, Rayleigh};
use nalgebra::{Matrix2, Vector2};

/// A particle in the ring potential with isotropic drag, as in the scene `ring`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RingByHand {
    /// Coefficient of the drag.
    pub k: f64,
}

impl Lagrangian<2> for RingByHand {
    type Scalar = f64;

    fn lagrangian(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
        let s = q.norm_squared();
        0.5 * v.norm_squared() - s * (s - 1.0).powi(2)
    }

    fn lagrangian_derivatives(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> Derivatives<f64, 2> {
        let s = q.norm_squared();
        let (first, second) = ((s - 1.0) * (3.0 * s - 1.0), 6.0 * s - 4.0);
        Derivatives {
            value: self.lagrangian(q, v),
            d1: -2.0 * first * q,
            d2: *v,
            d11: -2.0 * first * Matrix2::identity() - 4.0 * second * q * q.transpose(),
            d12: Matrix2::zeros(),
            d22: Matrix2::identity(),
        }
    }
}

impl Rayleigh<2> for RingByHand {
    fn rayleigh(&self, _q: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
        0.5 * self.k * v.norm_squared()
    }

    fn rayleigh_derivatives(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> Derivatives<f64, 2> {
        Derivatives {
            value: self.rayleigh(q, v),
            d2: self.k * v,
            d22: self.k * Matrix2::identity(),
            ..Derivatives::zero()
        }
    }
}

impl ActingForce<2> for RingByHand {
    const HAS_RAYLEIGH: bool = true;

    fn dissipation_derivatives(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> Derivatives<f64, 2> {
        self.rayleigh_derivatives(q, v)
    }
}

/// The rule supplies the formulas; a system sums one term for each of L and R.
impl Fused<Midpoint, 2> for RingByHand {
    type Matrix = Matrix2<f64>;
    type Memory = VelocityHistory<f64, 2>;
    type Border = dalembert::step::Free;

    fn step_kernel(&self, segment: &Segment<f64, 2>) -> StepKernel<f64, 2> {
        Midpoint::lagrangian_kernel(self, segment) + Midpoint::rayleigh_kernel(self, segment)
    }

    fn momenta(&self, segment: &Segment<f64, 2>) -> Momenta<f64, 2> {
        Midpoint::lagrangian_momenta(self, segment) + Midpoint::rayleigh_momenta(self, segment)
    }
}
