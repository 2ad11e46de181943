//! Which force acts: what of its Rayleigh function and its general force a system is asked about.

use nalgebra::SVector;

use crate::numbers::CovectorDerivatives;
use crate::system::{Force, Lagrangian, Rayleigh};

/// The continuous force f_L(q, v) that acts on a system, put together from what the system has.
///
/// Four types implement it, one for each combination: [`Unforced`], [`RayleighForce`], [`GeneralForce`] and
/// [`RayleighAndGeneralForce`]; [`Exact`](super::Exact) has a constructor for each.
#[diagnostic::on_unimplemented(
    message = "`{L}` does not have what `{Self}` needs",
    note = "`RayleighForce` needs `fn rayleigh`, `GeneralForce` needs `fn force` in the `#[rayleigh_system]` block"
)]
pub trait ActingForce<L: Lagrangian<N>, const N: usize>: Copy {
    /// f_L(q, v) with ∂f_L/∂q and ∂f_L/∂v.
    fn derivatives(
        system: &L,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> CovectorDerivatives<L::Scalar, N>;
}

/// f_L = 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unforced;

/// f_L = −∂R/∂v.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayleighForce;

/// f_L = f.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GeneralForce;

/// f_L = −∂R/∂v + f.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RayleighAndGeneralForce;

impl<L: Lagrangian<N>, const N: usize> ActingForce<L, N> for Unforced {
    #[inline]
    fn derivatives(
        _system: &L,
        _q: &SVector<L::Scalar, N>,
        _v: &SVector<L::Scalar, N>,
    ) -> CovectorDerivatives<L::Scalar, N> {
        CovectorDerivatives::zero()
    }
}

impl<L: Rayleigh<N>, const N: usize> ActingForce<L, N> for RayleighForce {
    #[inline]
    fn derivatives(
        system: &L,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> CovectorDerivatives<L::Scalar, N> {
        let r = system.rayleigh_derivatives(q, v);
        CovectorDerivatives { value: -r.d2, d1: -r.d12.transpose(), d2: -r.d22 }
    }
}

impl<L: Force<N>, const N: usize> ActingForce<L, N> for GeneralForce {
    #[inline]
    fn derivatives(
        system: &L,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> CovectorDerivatives<L::Scalar, N> {
        system.force_derivatives(q, v)
    }
}

impl<L: Rayleigh<N> + Force<N>, const N: usize> ActingForce<L, N> for RayleighAndGeneralForce {
    #[inline]
    fn derivatives(
        system: &L,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> CovectorDerivatives<L::Scalar, N> {
        RayleighForce::derivatives(system, q, v) + GeneralForce::derivatives(system, q, v)
    }
}
