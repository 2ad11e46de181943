//! Systems differentiated once more than a step asks for: third derivatives of L and R, contracted with
//! vectors.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Hessian;
use crate::system::Lagrangian;

/// L, R and f differentiated once more than a step asks for: `#[rayleigh_system(step_derivatives = second)]`
/// writes it.
///
/// M is the number of inputs, 0 where there are none.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no second derivatives of its step",
    label = "no second derivatives",
    note = "ask for them in the attribute: `#[rayleigh_system(step_derivatives = second)]`"
)]
pub trait SecondOrder<const N: usize, const M: usize>: Lagrangian<N> {
    /// Second derivatives by (q, v) of `a`·∂L/∂q + `b`·∂L/∂v.
    fn lagrangian_along(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        a: &SVector<Self::Scalar, N>,
        b: &SVector<Self::Scalar, N>,
    ) -> Hessian<Self::Scalar, N, M>;

    /// Second derivatives by (q, v) of `a`·∂R/∂q + `b`·∂R/∂v; 0 where there is no R.
    #[inline]
    fn rayleigh_along(
        &self,
        _q: &SVector<Self::Scalar, N>,
        _v: &SVector<Self::Scalar, N>,
        _a: &SVector<Self::Scalar, N>,
        _b: &SVector<Self::Scalar, N>,
    ) -> Hessian<Self::Scalar, N, M> {
        Hessian::zero()
    }

    /// Second derivatives by (q, v, u) of `vector`·f; 0 where there is no f.
    #[inline]
    fn force_along(
        &self,
        _q: &SVector<Self::Scalar, N>,
        _v: &SVector<Self::Scalar, N>,
        _vector: &SVector<Self::Scalar, N>,
    ) -> Hessian<Self::Scalar, N, M> {
        Hessian::zero()
    }

    /// ∂f/∂u at (q, v), shape N×M, for rules with interior points:
    /// [`Driven::force_by_input`](crate::system::Driven::force_by_input) where there is an input.
    #[inline]
    fn force_slope_by_input(
        &self,
        _q: &SVector<Self::Scalar, N>,
        _v: &SVector<Self::Scalar, N>,
    ) -> SMatrix<Self::Scalar, N, M> {
        const { assert!(M == 0, "a system with an input has `Driven::force_by_input(self, q, v)` here") };
        SMatrix::zeros()
    }
}
