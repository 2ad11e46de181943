//! R and f of a system, of which no trait says at compile time which it has.

use nalgebra::SVector;

use crate::numbers::{CovectorDerivatives, Derivatives, Gradient};
use crate::system::{ActingForce, Force, Lagrangian, Rayleigh};

/// A system by the parts of its force, whichever it has, `elapsed` from now.
pub(super) struct Parts<'a, L: Lagrangian<N>, const N: usize> {
    system: &'a L,
    elapsed: L::Scalar,
}

impl<'a, L: Lagrangian<N>, const N: usize> Parts<'a, L, N> {
    pub(super) fn of(system: &'a L) -> Self {
        Self { system, elapsed: nalgebra::zero() }
    }
}

impl<L: ActingForce<N>, const N: usize> Lagrangian<N> for Parts<'_, L, N> {
    type Scalar = L::Scalar;

    fn lagrangian(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> L::Scalar {
        self.system.later(self.elapsed, |system| system.lagrangian(q, v))
    }

    fn lagrangian_derivatives(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        self.system.later(self.elapsed, |system| system.lagrangian_derivatives(q, v))
    }

    fn later<T>(&self, elapsed: L::Scalar, evaluate: impl FnOnce(&Self) -> T) -> T {
        evaluate(&Self { system: self.system, elapsed: self.elapsed + elapsed })
    }
}

impl<L: ActingForce<N>, const N: usize> Rayleigh<N> for Parts<'_, L, N> {
    fn rayleigh(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> L::Scalar {
        self.rayleigh_gradient(q, v).value
    }

    fn rayleigh_gradient(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Gradient<L::Scalar, N> {
        self.system.later(self.elapsed, |system| system.dissipation(q, v))
    }

    fn rayleigh_derivatives(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        self.system.later(self.elapsed, |system| system.dissipation_derivatives(q, v))
    }
}

impl<L: ActingForce<N>, const N: usize> Force<N> for Parts<'_, L, N> {
    fn force(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> SVector<L::Scalar, N> {
        self.system.later(self.elapsed, |system| system.general_force(q, v))
    }

    fn force_derivatives(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> CovectorDerivatives<L::Scalar, N> {
        self.system.later(self.elapsed, |system| system.general_force_derivatives(q, v))
    }
}
