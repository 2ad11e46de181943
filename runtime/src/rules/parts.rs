//! R and f of a system, of which no trait says at compile time which it has.

use core::marker::PhantomData;

use nalgebra::SVector;

use crate::numbers::{CovectorDerivatives, Derivatives, Gradient};
use crate::system::{ActingForce, Force, Lagrangian, Rayleigh, SmoothRayleigh};

/// A system by the parts of its force, whichever it has, `elapsed` from now; of R all of it, or `K` of it.
pub(super) struct Parts<'a, L: Lagrangian<N>, K, const N: usize> {
    system: &'a L,
    elapsed: L::Scalar,
    of_rayleigh: PhantomData<K>,
}

/// All of R.
pub(super) struct Whole;

/// R without its kinks.
pub(super) struct Smooth;

impl<'a, L: Lagrangian<N>, const N: usize> Parts<'a, L, Whole, N> {
    pub(super) fn of(system: &'a L) -> Self {
        Self { system, elapsed: nalgebra::zero(), of_rayleigh: PhantomData }
    }
}

impl<'a, L: Lagrangian<N>, const N: usize> Parts<'a, L, Smooth, N> {
    pub(super) fn smooth(system: &'a L) -> Self {
        Self { system, elapsed: nalgebra::zero(), of_rayleigh: PhantomData }
    }
}

impl<L: Lagrangian<N>, K, const N: usize> Lagrangian<N> for Parts<'_, L, K, N> {
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
        evaluate(&Self { system: self.system, elapsed: self.elapsed + elapsed, of_rayleigh: PhantomData })
    }
}

impl<L: ActingForce<N>, const N: usize> Rayleigh<N> for Parts<'_, L, Whole, N> {
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

impl<L: SmoothRayleigh<N>, const N: usize> ActingForce<N> for Parts<'_, L, Smooth, N> {
    const HAS_RAYLEIGH: bool = L::HAS_SMOOTH;
    const HAS_FORCE: bool = L::HAS_FORCE;
    const IS_TIMED: bool = L::IS_TIMED;

    fn dissipation_derivatives(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Derivatives<L::Scalar, N> {
        self.system.later(self.elapsed, |system| system.smooth_rayleigh_derivatives(q, v))
    }

    fn general_force_derivatives(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> CovectorDerivatives<L::Scalar, N> {
        self.system.later(self.elapsed, |system| system.general_force_derivatives(q, v))
    }
}

impl<L: ActingForce<N>, const N: usize> Force<N> for Parts<'_, L, Whole, N> {
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
