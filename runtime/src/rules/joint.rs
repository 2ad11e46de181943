//! Rules that take L and R together: the damping enters L_d as well as the force.

use nalgebra::SVector;

use super::{DisplacementRule, Midpoint};
use crate::numbers::Derivatives;
use crate::step::{DiscreteForce, DiscreteForceDerivatives, Momenta, Segment, StepKernel};
use crate::system::{ActingForce, Rayleigh};

/// A rule whose discrete objects need L and R at once.
///
/// The functions are those of [`Discrete`](crate::Discrete).
pub trait JointRule: Copy {
    /// L_d(q0, q1, h).
    fn discrete_lagrangian<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar;

    /// L_d with its derivatives by q0 and q1.
    fn discrete_lagrangian_derivatives<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N>;

    /// f_d⁻ and f_d⁺.
    fn discrete_force<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForce<L::Scalar, N>;

    /// f_d with its derivatives by q0 and q1.
    fn discrete_force_derivatives<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> DiscreteForceDerivatives<L::Scalar, N>;

    /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄, at q1 = q0 + h v̄.
    fn step_kernel<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> StepKernel<L::Scalar, N>;

    /// p0 and p1 = D2 L_d + f_d⁺, at q1 = q0 + h v̄.
    fn momenta<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Momenta<L::Scalar, N>;

    /// Sizes of the terms that may cancel in p0 ([`ActingForce::cancelling_terms`]); 0 unless the rule says
    /// otherwise.
    #[cold]
    fn cancelling_terms<L: ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> SVector<L::Scalar, N> {
        let _ = (system, segment);
        nalgebra::zero()
    }

    /// E_L on the segment.
    fn segment_energy<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar;

    /// Calls `visit` with the system and (q, v) at the middle of the segment.
    #[expect(clippy::type_complexity, reason = "a visitor, in full: an alias would hide its lifetime")]
    fn at_nodes<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
        visit: &mut dyn FnMut(&L, &SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
    ) {
        Midpoint::at_nodes(system, segment, visit);
    }
}

/// A rule that takes L and R together, and whose force is that of one function R_d.
pub trait JointRayleighRule: JointRule {
    /// R_d(q0, q1, h), with f_d⁻ = D1 R_d and f_d⁺ = −D2 R_d.
    fn discrete_rayleigh<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> L::Scalar;

    /// R_d with its derivatives by q0 and q1.
    fn discrete_rayleigh_derivatives<L: Rayleigh<N> + ActingForce<N>, const N: usize>(
        system: &L,
        segment: &Segment<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N>;
}
