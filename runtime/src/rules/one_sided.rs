use nalgebra::SVector;

use super::{DisplacementRule, JointRayleighRule, JointRule, Midpoint};
use crate::numbers::{Derivatives, Scalar};
use crate::step::{DiscreteForce, DiscreteForceDerivatives, Momenta, SolvedForVelocity, StepKernel};
use crate::system::{ActingForce, Rayleigh};

/// The midpoint rule with all of the damping at the start of the segment: L-stable in the damping for every
/// convex R(v) (stiff springs it follows as the midpoint rule does), of order 1.
///
/// ```text
/// L_d = h L(q̄, v̄) + (h²/2) R(v̄),   R_d = (h²/2) R(v̄)
/// p0 = −D1[h L(q̄, v̄)] + h ∂R/∂v(v̄),   p1 = D2[h L(q̄, v̄)]
/// ```
///
/// **Derivation.** f_d⁺ = 0 puts the whole force h ∂R/∂v on q0: backward Euler in the damping. The same step
/// re-split with f_d⁻ = D1 R_d and f_d⁺ = −D2 R_d is the pair above.
///
/// A damped free mass slows down by 1/(1 + hr/m) a step, and dry friction, regularised, neither rings nor
/// creeps back. Not self-adjoint: for stiff and not linear damping alone, and for convex R, which nothing
/// checks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OneSided;

impl SolvedForVelocity for OneSided {}

impl JointRule for OneSided {
    #[inline]
    fn discrete_lagrangian<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> L::Scalar {
        Midpoint::discrete_lagrangian(system, q0, q1, h) + Midpoint::discrete_rayleigh(system, q0, q1, h)
    }

    #[inline]
    fn discrete_lagrangian_derivatives<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> Derivatives<L::Scalar, N> {
        Midpoint::discrete_lagrangian_derivatives(system, q0, q1, h)
            + Midpoint::discrete_rayleigh_derivatives(system, q0, q1, h)
    }

    #[inline]
    fn discrete_force<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> DiscreteForce<L::Scalar, N> {
        Midpoint::rayleigh_force(system, q0, q1, h)
    }

    #[inline]
    fn discrete_force_derivatives<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> DiscreteForceDerivatives<L::Scalar, N> {
        Midpoint::rayleigh_force_derivatives(system, q0, q1, h)
    }

    #[inline]
    fn step_kernel<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> StepKernel<L::Scalar, N> {
        let r = system.rayleigh_derivatives(q0, v);
        Midpoint::lagrangian_kernel(system, q0, v, h) + StepKernel { p0: r.d2, matrix: r.d22 } * h
    }

    #[inline]
    fn momenta<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> Momenta<L::Scalar, N> {
        let drag = system.rayleigh_gradient(q0, v).d2 * h;
        Midpoint::lagrangian_momenta(system, q0, v, h) + Momenta { p0: drag, p1: nalgebra::zero() }
    }

    #[cold]
    fn cancelling_terms<L: ActingForce<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> SVector<L::Scalar, N> {
        // Half of the potential's force, the whole of the drag.
        Midpoint::cancelling_terms(system, q0, v, h) * L::Scalar::constant(2.0)
    }

    #[inline]
    fn segment_energy<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> L::Scalar {
        Midpoint::segment_energy(system, q0, q1, h)
    }
}

impl JointRayleighRule for OneSided {
    #[inline]
    fn discrete_rayleigh<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> L::Scalar {
        Midpoint::discrete_rayleigh(system, q0, q1, h)
    }

    #[inline]
    fn discrete_rayleigh_derivatives<L: Rayleigh<N>, const N: usize>(
        system: &L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> Derivatives<L::Scalar, N> {
        Midpoint::discrete_rayleigh_derivatives(system, q0, q1, h)
    }
}
