//! Holonomic constraints g(q) = 0, and what a point off them is told.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;
use crate::system::{Lagrangian, Violation};

/// Holonomic constraints gₖ(q) = 0, k = 1 … M, that hold a system on N = g⁻¹(0).
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no constraints as it stands here",
    label = "no constraints",
    note = "add `fn constraints(&self, q: [f64; {N}]) -> [f64; M]` to the `#[rayleigh_system]` block",
    note = "a system whose functions take an input or a time has them as `system.driven(u)` or `system.at_time(t)`"
)]
pub trait Constrained<const N: usize, const M: usize>: Lagrangian<N> {
    /// g(q).
    fn constraints(&self, q: &SVector<Self::Scalar, N>) -> SVector<Self::Scalar, M>;

    /// g(q), and G = ∂g/∂q of shape M×N.
    fn constraint_gradients(
        &self,
        q: &SVector<Self::Scalar, N>,
    ) -> (SVector<Self::Scalar, M>, SMatrix<Self::Scalar, M, N>);

    /// Σ λₖ ∂²gₖ/∂q², which derivatives of a step ask for; the step itself does not.
    fn constraint_curvature(
        &self,
        q: &SVector<Self::Scalar, N>,
        lambda: &SVector<Self::Scalar, M>,
    ) -> SMatrix<Self::Scalar, N, N>;
}

/// Roundings of the terms of gₖ and of its rate that a point on the constraints may be off, given as rounded
/// numbers by whoever computed it.
const ROUNDINGS: f64 = 1024.0;

/// The first constraint that (q, v) violates by more than rounding explains, if any:
/// [`Lagrangian::violation`] of a system with constraints.
#[cold]
pub fn violation<L, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Option<Violation>
where
    L: Constrained<N, M> + ?Sized,
{
    let (values, gradients) = system.constraint_gradients(q);
    if let Some((constraint, value)) = off(&values, &gradients, q) {
        return Some(Violation::Off { constraint, value: value.widen() });
    }
    let (rates, sizes) = (gradients * v, sizes(&gradients, v));
    let rounded = rates.as_slice().iter().zip(sizes.as_slice());
    for (constraint, (rate, size)) in rounded.enumerate() {
        if exceeds(*rate, *size) {
            return Some(Violation::Leaving { constraint, rate: rate.widen() });
        }
    }
    None
}

/// The first constraint whose value at q rounding does not explain, with the value.
pub(crate) fn off<S: Scalar, const N: usize, const M: usize>(
    values: &SVector<S, M>,
    gradients: &SMatrix<S, M, N>,
    q: &SVector<S, N>,
) -> Option<(usize, S)> {
    // A constraint of a distance has terms of the size of its gradient, wherever the origin is.
    let sizes = sizes(gradients, &(q.abs() + SVector::repeat(S::one())));
    let mut rounded = values.as_slice().iter().zip(sizes.as_slice()).enumerate();
    rounded.find(|(_, (value, size))| exceeds(**value, **size)).map(|(k, (value, _))| (k, *value))
}

/// Whether rounding of terms of this size does not explain the amount.
fn exceeds<S: Scalar>(amount: S, size: S) -> bool {
    let most = size * (S::EPSILON * S::constant(ROUNDINGS));
    amount.abs() > most || !amount.is_finite()
}

/// Σⱼ |Gₖⱼ||xⱼ| for each constraint k.
pub(crate) fn sizes<S: Scalar, const N: usize, const M: usize>(
    gradients: &SMatrix<S, M, N>,
    x: &SVector<S, N>,
) -> SVector<S, M> {
    let mut sums: SVector<S, M> = nalgebra::zero();
    for (column, x) in gradients.data.0.iter().zip(x.as_slice()) {
        for (sum, entry) in sums.as_mut_slice().iter_mut().zip(column) {
            *sum += (*entry * *x).abs();
        }
    }
    sums
}
