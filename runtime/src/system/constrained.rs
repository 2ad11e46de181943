//! Holonomic constraints g(q) = 0, and what a point off them is told.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;
use crate::system::Lagrangian;

/// Holonomic constraints gₖ(q) = 0, k = 1 … M, that hold a system on N = g⁻¹(0).
///
/// A function of time, g(q, t), is one of a view, at the time of the view.
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

    /// ∂g/∂t; 0 where no constraint takes the time.
    #[inline]
    fn constraint_rates(&self, q: &SVector<Self::Scalar, N>) -> SVector<Self::Scalar, M> {
        let _ = q;
        nalgebra::zero()
    }
}

/// The constraint that a point (q, v) violates, and by how much.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Violation {
    /// q is off the constraint.
    Off {
        /// The constraint k, from 0.
        constraint: usize,
        /// gₖ(q).
        value: f64,
    },
    /// q is on the constraints, and v leaves one.
    Leaving {
        /// The constraint k, from 0.
        constraint: usize,
        /// ∂gₖ/∂q·v + ∂gₖ/∂t.
        rate: f64,
    },
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
    let rates = system.constraint_rates(q);
    for constraint in 0..M {
        let size = sizes(&gradients, q, constraint);
        let value = values[constraint];
        // A constraint of a distance has terms of the size of its gradient, wherever the origin is.
        if exceeds(value, size + largest(&gradients, constraint)) {
            return Some(Violation::Off { constraint, value: value.widen() });
        }
    }
    for constraint in 0..M {
        let mut rate = rates[constraint];
        for j in 0..N {
            rate += gradients[(constraint, j)] * v[j];
        }
        if exceeds(rate, sizes(&gradients, v, constraint) + rates.abs()[constraint]) {
            return Some(Violation::Leaving { constraint, rate: rate.widen() });
        }
    }
    None
}

/// Whether rounding of terms of this size does not explain the amount.
fn exceeds<S: Scalar>(amount: S, size: S) -> bool {
    let most = size * (S::EPSILON * S::constant(ROUNDINGS));
    amount.abs() > most || !amount.is_finite()
}

/// Σⱼ |Gₖⱼ||xⱼ|.
pub(crate) fn sizes<S: Scalar, const N: usize, const M: usize>(
    gradients: &SMatrix<S, M, N>,
    x: &SVector<S, N>,
    constraint: usize,
) -> S {
    let mut size = S::zero();
    for j in 0..N {
        size += (gradients[(constraint, j)] * x[j]).abs();
    }
    size
}

/// maxⱼ |Gₖⱼ|.
fn largest<S: Scalar, const N: usize, const M: usize>(gradients: &SMatrix<S, M, N>, constraint: usize) -> S {
    let mut largest = S::zero();
    for j in 0..N {
        largest = largest.max(gradients[(constraint, j)].abs());
    }
    largest
}
