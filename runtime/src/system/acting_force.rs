//! The force that acts on a system, in one place: what it has of R and f.
//!
//! ```text
//! f_L = −∂R/∂v + f
//! ```

use nalgebra::SVector;

use crate::numbers::{CancellingTerms, CovectorDerivatives, Derivatives, Gradient, Scalar};
use crate::system::Lagrangian;

/// The force f_L(q, v) = −∂R/∂v + f that acts on a system: of R and f the terms that it has.
///
/// `#[rayleigh_system]` writes it for every system. By hand, a system without force needs nothing but the
/// `impl`; one with R sets [`HAS_RAYLEIGH`](Self::HAS_RAYLEIGH) and hands R on, one with f sets
/// [`HAS_FORCE`](Self::HAS_FORCE) and hands f on; one that changes with time sets
/// [`IS_TIMED`](Self::IS_TIMED).
///
/// It is no part of [`Lagrangian`], with 0 where nothing is said: a system whose force takes an input has an
/// L by itself, and a force through a view alone. Without the view no step compiles, where a default would
/// leave out the force.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no force as it stands here",
    label = "which force acts is not known",
    note = "if its force takes an input, write `system.driven(u)` where `system` stands; if L, R or f take the time, `system.at_time(t)`, with an input `system.driven(u, t)`",
    note = "a system written by hand states it: `impl dalembert::system::ActingForce<{N}> for {Self} {{}}` where there is none"
)]
pub trait ActingForce<const N: usize>: Lagrangian<N> {
    /// Whether there is a Rayleigh function.
    const HAS_RAYLEIGH: bool = false;

    /// Whether there is a general force.
    const HAS_FORCE: bool = false;

    /// Whether there is a force. Without one, f_d and its derivatives are 0 and cost nothing.
    const IS_FORCED: bool = Self::HAS_RAYLEIGH || Self::HAS_FORCE;

    /// Whether L or the force changes with time, so that [`Lagrangian::later`] is another system. Without it
    /// no stage asks.
    const IS_TIMED: bool = false;

    /// R with ∂R/∂q and ∂R/∂v; 0 where there is none.
    #[inline]
    fn dissipation(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> Gradient<Self::Scalar, N> {
        self.dissipation_derivatives(q, v).gradient()
    }

    /// R with its first and second derivatives; 0 where there is none.
    #[inline]
    fn dissipation_derivatives(
        &self,
        _q: &SVector<Self::Scalar, N>,
        _v: &SVector<Self::Scalar, N>,
    ) -> Derivatives<Self::Scalar, N> {
        Derivatives::zero()
    }

    /// f; 0 where there is none.
    #[inline]
    fn general_force(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> SVector<Self::Scalar, N> {
        self.general_force_derivatives(q, v).value
    }

    /// f with ∂f/∂q and ∂f/∂v; 0 where there is none.
    #[inline]
    fn general_force_derivatives(
        &self,
        _q: &SVector<Self::Scalar, N>,
        _v: &SVector<Self::Scalar, N>,
    ) -> CovectorDerivatives<Self::Scalar, N> {
        CovectorDerivatives::zero()
    }

    /// f_L(q, v), a covector at q.
    #[inline]
    fn acting_force(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> SVector<Self::Scalar, N> {
        match (Self::HAS_RAYLEIGH, Self::HAS_FORCE) {
            (true, true) => -self.dissipation(q, v).d2 + self.general_force(q, v),
            (true, false) => -self.dissipation(q, v).d2,
            (false, true) => self.general_force(q, v),
            (false, false) => nalgebra::zero(),
        }
    }

    /// f_L with ∂f_L/∂q and ∂f_L/∂v.
    #[inline]
    fn acting_force_derivatives(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> CovectorDerivatives<Self::Scalar, N> {
        let of_rayleigh = || force_of_rayleigh(&self.dissipation_derivatives(q, v));
        match (Self::HAS_RAYLEIGH, Self::HAS_FORCE) {
            (true, true) => of_rayleigh() + self.general_force_derivatives(q, v),
            (true, false) => of_rayleigh(),
            (false, true) => self.general_force_derivatives(q, v),
            (false, false) => CovectorDerivatives::zero(),
        }
    }

    /// Sizes of the terms that may cancel in ∂L/∂v and in g = ∂L/∂q + f_L, component by component: each as
    /// computed is off by ε times that, where last places of q and v do not show it, as in (q − 1) + (q + 1)
    /// at rest.
    ///
    /// Generated where L, R or f have such terms; 0 otherwise. A step whose residual stops falling asks for
    /// it, no other.
    #[cold]
    fn cancelling_terms(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> CancellingTerms<Self::Scalar, N> {
        let _ = (q, v);
        CancellingTerms { momentum: nalgebra::zero(), rate: nalgebra::zero() }
    }
}

/// −∂R/∂v with its derivatives, from those of R.
#[inline]
pub(crate) fn force_of_rayleigh<S: Scalar, const N: usize>(
    r: &Derivatives<S, N>,
) -> CovectorDerivatives<S, N> {
    // By loops: operators of matrices are a hundred functions to compile, in every program with friction.
    let mut force = CovectorDerivatives::zero();
    for i in 0..N {
        force.value.data.0[0][i] = -r.d2.data.0[0][i];
        for j in 0..N {
            force.d1.data.0[j][i] = -r.d12.data.0[i][j];
            force.d2.data.0[j][i] = -r.d22.data.0[j][i];
        }
    }
    force
}
