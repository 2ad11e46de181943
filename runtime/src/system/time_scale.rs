//! Systems whose runs can follow a time scale.

use nalgebra::SVector;

use crate::system::Lagrangian;

/// A system with a time scale σ(q) > 0: steps that follow it are equal in τ, dt = σ(q) dτ
/// ([`Trajectory::in_scaled_time`](crate::Trajectory::in_scaled_time)).
/// `fn time_scale(&self, q: [f64; N]) -> f64` in the annotated block writes it.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no time scale",
    label = "no time scale",
    note = "write `fn time_scale(&self, q: [f64; N]) -> f64` beside `fn lagrangian`"
)]
pub trait TimeScale<const N: usize>: Lagrangian<N> {
    /// σ(q), in units of t over those of τ.
    fn time_scale(&self, q: &SVector<Self::Scalar, N>) -> Self::Scalar;

    /// σ(q) and ∇σ(q).
    fn time_scale_gradient(&self, q: &SVector<Self::Scalar, N>) -> (Self::Scalar, SVector<Self::Scalar, N>);
}
