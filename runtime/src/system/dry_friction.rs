//! Kinks of R: friction that holds.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Derivatives;
use crate::system::ActingForce;

/// R without its kinks, as rules see it that take these apart.
pub trait SmoothRayleigh<const N: usize>: ActingForce<N> {
    /// Whether anything is left of R.
    const HAS_SMOOTH: bool = false;

    /// R without its kinks, with its first and second derivatives; 0 where it is nothing.
    fn smooth_rayleigh_derivatives(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> Derivatives<Self::Scalar, N> {
        let _ = (q, v);
        Derivatives::zero()
    }
}

/// The kinks of a Rayleigh function, R_k = Σₖ Fₖ |uₖ| with M components in all: each uₖ(q, v), a slip, is
/// linear in v and of one component or several, and Fₖ(q) ≥ 0 is the most that the friction force along it
/// holds.
///
/// `#[rayleigh_system(rule = proximal)]` finds them: `abs`, `max`, `min`, `hypot` and `sqrt` of a sum of
/// squares in R, of what is linear in v.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no dry friction as it stands here",
    label = "no kinks of R",
    note = "list the rule, `#[rayleigh_system(rule = proximal)]`, of a system whose R has |v| in it"
)]
pub trait DryFriction<const N: usize, const M: usize>: SmoothRayleigh<N> {
    /// How many components each element has: 1 of |u|, more of a length. M is their sum.
    const ELEMENTS: &'static [usize];

    /// Whether slips and limits are the same at every q: no coordinate stands in R beside its kinks.
    const IS_UNIFORM: bool;

    /// Whether R holds each |uₖ| with a factor alone, and not in another function: then friction does not
    /// fall with the velocity.
    const IS_PROPORTIONAL: bool;

    /// Slips and limits at (q, v).
    fn slips(&self, q: &SVector<Self::Scalar, N>, v: &SVector<Self::Scalar, N>) -> Slips<Self::Scalar, N, M>;

    /// ∂/∂q of Σₖ Fₖ sₖ·∂uₖ/∂v, which derivatives of a step ask for; 0 where slips and limits are the same at
    /// every q.
    fn slip_curvature(
        &self,
        q: &SVector<Self::Scalar, N>,
        forces: &SVector<Self::Scalar, M>,
    ) -> SMatrix<Self::Scalar, N, N> {
        let _ = (q, forces);
        nalgebra::zero()
    }
}

/// The elements of dry friction at (q, v).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slips<S, const N: usize, const M: usize> {
    /// u, component by component.
    pub values: SVector<S, M>,
    /// ∂u/∂v, shape M×N.
    pub by_velocity: SMatrix<S, M, N>,
    /// ∂u/∂q, shape M×N.
    pub by_configuration: SMatrix<S, M, N>,
    /// F, for each component that of its element.
    pub limits: SVector<S, M>,
}

/// Slips and limits by the P parameters that [`Parameters`](crate::system::Parameters) lists.
pub trait DryFrictionParameters<const N: usize, const M: usize, const P: usize>: DryFriction<N, M> {
    /// ∂u/∂θ, and ∂/∂θ of Σₖ Fₖ sₖ·∂uₖ/∂v at fixed `forces` s, at (q, v).
    fn slips_by_parameters(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        forces: &SVector<Self::Scalar, M>,
    ) -> SlipsBy<Self::Scalar, N, M, P>;
}

/// The derivatives of dry friction by P parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipsBy<S, const N: usize, const M: usize, const P: usize> {
    /// ∂u/∂θ, shape M×P.
    pub values: SMatrix<S, M, P>,
    /// ∂/∂θ of the friction force Σₖ Fₖ sₖ·∂uₖ/∂v, shape N×P.
    pub force: SMatrix<S, N, P>,
}
