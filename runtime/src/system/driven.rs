//! Systems with an input u ∈ ℝᴹ, which is held over a step.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;
use crate::system::Force;

/// An input u ∈ ℝᴹ as `system.driven(u)` takes it: `[S; M]`, or an `SVector<S, M>`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not an input of this system: it takes an array `[{S}; {M}]`, or an `SVector<{S}, {M}>`",
    label = "not `[{S}; {M}]`"
)]
pub trait Input<S, const M: usize> {
    /// u₁ … u_M.
    fn entries(self) -> [S; M];
}

impl<S: Scalar, const M: usize> Input<S, M> for [S; M] {
    #[inline]
    fn entries(self) -> [S; M] {
        self
    }
}

impl<S: Scalar, const M: usize> Input<S, M> for SVector<S, M> {
    #[inline]
    fn entries(self) -> [S; M] {
        self.into()
    }
}

/// A system with its input u ∈ ℝᴹ held: the views that `#[rayleigh_system]` makes of systems with
/// `fn force(&self, q: [f64; N], v: [f64; N], u: [f64; M]) -> [f64; N]`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no input with M = {M}",
    label = "no input",
    note = "write `fn force(&self, q: [f64; {N}], v: [f64; {N}], u: [f64; {M}]) -> [f64; {N}]` in the `#[rayleigh_system]` block, and hold the input with `system.driven(u)`"
)]
pub trait Driven<const N: usize, const M: usize>: Force<N> {
    /// ∂f/∂u at (q, v) and the input held, shape N×M: entry (i, j) is ∂fᵢ/∂uⱼ.
    fn force_by_input(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> SMatrix<Self::Scalar, N, M>;
}
