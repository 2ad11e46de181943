//! The same systems with the step's equation and both momenta derived and written by hand: shared
//! subexpressions, the pattern of zeros, constants of the system worked out beforehand.
//!
//! With G = ∂L/∂q − ∂R/∂v and a = h/2 (R depends on v alone in every scene), at q̄ = q0 + a v̄:
//!
//! ```text
//! p0 = ∂L/∂v − a G,   p1 = ∂L/∂v + a G,   ∂p0/∂v̄ = L_vv + a (L_vq − L_qv + R_vv) − a² L_qq
//! ```

mod arm;
mod double_pendulum;
mod fput_chain;
mod pendulum_chain;
mod ring;
mod spring_chain;

pub use arm::Arm;
pub use double_pendulum::DoublePendulum;
pub use fput_chain::FputChain;
pub use pendulum_chain::PendulumChain;
pub use ring::Ring;
pub use spring_chain::SpringChain;

use dalembert::nalgebra::SVector;
use dalembert::rules::Fused;
use dalembert::step::{Memory, Momenta, NewtonMatrix, Segment, StepKernel};
use dalembert::system::{ActingForce, Derivatives, Gradient};
use dalembert::{Discrete, Lagrangian, Midpoint};

/// What a step evaluates, by hand.
pub trait HandDerived<const N: usize>: Sized {
    /// The generated system, for what no step but the first evaluates.
    type Generated: Discrete<Midpoint, N, Scalar = f64>;

    /// The form of the Newton matrix: banded for the chains of springs.
    type Matrix: NewtonMatrix<f64, N>;

    /// What a run keeps from step to step: what the attribute would choose.
    type Memory: Memory<ByHand<Self>, Midpoint, N>;

    /// The generated system.
    fn generated(&self) -> &Self::Generated;

    /// p0 and ∂p0/∂v̄.
    fn step_kernel(&self, segment: &Segment<f64, N>) -> StepKernel<f64, N, Self::Matrix>;

    /// p0 and p1.
    fn momenta(&self, segment: &Segment<f64, N>) -> Momenta<f64, N>;
}

/// A system whose step is derived by hand: the runtime's solver, guess and reports over hand-written
/// derivatives.
pub struct ByHand<K>(pub K);

impl<K: HandDerived<N>, const N: usize> Lagrangian<N> for ByHand<K> {
    type Scalar = f64;

    fn lagrangian(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        self.0.generated().lagrangian(q, v)
    }

    fn lagrangian_gradient(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Gradient<f64, N> {
        self.0.generated().lagrangian_gradient(q, v)
    }

    fn lagrangian_derivatives(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Derivatives<f64, N> {
        self.0.generated().lagrangian_derivatives(q, v)
    }
}

/// As without a force: what steps evaluate of it is in their equation, and nothing else is asked for.
impl<K: HandDerived<N>, const N: usize> ActingForce<N> for ByHand<K> {}

impl<K: HandDerived<N>, const N: usize> Fused<Midpoint, N> for ByHand<K> {
    type Matrix = K::Matrix;
    type Memory = K::Memory;
    type Border = dalembert::step::Free;

    #[inline]
    fn step_kernel(&self, segment: &Segment<f64, N>) -> StepKernel<f64, N, K::Matrix> {
        self.0.step_kernel(segment)
    }

    #[inline]
    fn momenta(&self, segment: &Segment<f64, N>) -> Momenta<f64, N> {
        self.0.momenta(segment)
    }
}
