//! Event functions that a system states.

use nalgebra::SVector;

use crate::system::Lagrangian;

/// Event functions of a system: where one of them vanishes along a motion is an event.
///
/// Implemented by `#[rayleigh_system]` for a block with
/// `fn events(&self, q: [f64; N], v: [f64; N]) -> [f64; K]`, which may take the time `t: f64` after them.
/// They are plain functions of q, v, the fields and t; nothing differentiates them. `Moment::events` of
/// `run::between` asks for them, so that a run is watched.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no `fn events` that returns {K} numbers",
    label = "not stated in the block of this system",
    note = "write `fn events(&self, q: [f64; {N}], v: [f64; {N}]) -> [f64; {K}]` in the block of `#[rayleigh_system]`"
)]
pub trait EventFunctions<const N: usize, const K: usize>: Lagrangian<N> {
    /// Their values at (q, v).
    fn events(&self, q: &SVector<Self::Scalar, N>, v: &SVector<Self::Scalar, N>) -> [Self::Scalar; K];
}
