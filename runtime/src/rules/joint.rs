//! Rules that take L and R together: the damping enters L_d as well as the force.

use nalgebra::SVector;

use super::{DisplacementRule, Midpoint};
use crate::numbers::Derivatives;
use crate::step::{DiscreteForce, DiscreteForceDerivatives, Momenta, StepKernel};
use crate::system::{ActingForce, Rayleigh};

/// A rule whose discrete objects need L and R at once.
///
/// The functions are those of [`Discrete`](crate::Discrete).
pub trait JointRule: Copy {
    /// L_d(q0, q1, h).
    fn discrete_lagrangian<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> L::Scalar;

    /// L_d with its derivatives by q0 and q1.
    fn discrete_lagrangian_derivatives<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> Derivatives<L::Scalar, N>;

    /// f_d⁻ and f_d⁺.
    fn discrete_force<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> DiscreteForce<L::Scalar, N>;

    /// f_d with its derivatives by q0 and q1.
    fn discrete_force_derivatives<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> DiscreteForceDerivatives<L::Scalar, N>;

    /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄, at q1 = q0 + h v̄.
    fn step_kernel<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> StepKernel<L::Scalar, N>;

    /// p0 and p1 = D2 L_d + f_d⁺, at q1 = q0 + h v̄.
    fn momenta<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> Momenta<L::Scalar, N>;

    /// Sizes of the terms that may cancel in p0 ([`ActingForce::cancelling_terms`]); 0 unless the rule says
    /// otherwise.
    #[cold]
    fn cancelling_terms<L: ActingForce<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> SVector<L::Scalar, N> {
        let _ = (system, q0, v, h);
        nalgebra::zero()
    }

    /// E_L on the segment.
    fn segment_energy<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> L::Scalar;

    /// Calls `visit` with the system and (q, v) at the middle of the segment.
    #[expect(clippy::type_complexity, reason = "a visitor, in full: an alias would hide its lifetime")]
    fn at_nodes<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
        visit: &mut dyn FnMut(&L, &SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
    ) {
        Midpoint::at_nodes(system, q0, v, h, visit);
    }
}

/// A rule that takes L and R together, and whose force is that of one function R_d.
pub trait JointRayleighRule: JointRule {
    /// R_d(q0, q1, h), with f_d⁻ = D1 R_d and f_d⁺ = −D2 R_d.
    fn discrete_rayleigh<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> L::Scalar;

    /// R_d with its derivatives by q0 and q1.
    fn discrete_rayleigh_derivatives<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> Derivatives<L::Scalar, N>;
}
