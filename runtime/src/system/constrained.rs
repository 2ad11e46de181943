//! Constraints on q and on v, and the verdict on a point that is off them.

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;
use crate::system::{Lagrangian, Normals, Violation};

/// M constraints that hold a system: holonomic ones, gₖ(q, t) = 0, then those of velocity, ψₖ(q, v, t) = 0,
/// linear in v.
///
/// Each has a rate ρₖ(q, v), which vanishes along the motion: gₖ differentiated by time, or ψₖ. Reactions act
/// along the rows of G = ∂ρ/∂v, which is ∂g/∂q for holonomic constraints.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no constraints as it stands here",
    label = "no constraints",
    note = "add `fn constraints(&self, q: [f64; {N}]) -> [f64; M]` to the `#[rayleigh_system]` block",
    note = "a system whose functions take an input or a time has them as `system.driven(u)` or `system.at_time(t)`"
)]
pub trait Constrained<const N: usize, const M: usize>: Lagrangian<N> {
    /// The number of constraints of velocity: the last ones.
    const OF_VELOCITY: usize = 0;

    /// Whether a constraint may have a rate at rest: one that depends on time, or one of velocity with a term
    /// without v.
    const IS_PRESCRIBED: bool = false;

    /// g(q); 0 for a constraint of velocity.
    #[inline]
    fn constraints(&self, q: &SVector<Self::Scalar, N>) -> SVector<Self::Scalar, M> {
        let _ = q;
        nalgebra::zero()
    }

    /// ψ(q, v); 0 for a holonomic constraint.
    #[inline]
    fn velocity_constraints(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> SVector<Self::Scalar, M> {
        let _ = (q, v);
        nalgebra::zero()
    }

    /// g(q), 0 for a constraint of velocity, and G of shape M×N.
    fn constraint_gradients(
        &self,
        q: &SVector<Self::Scalar, N>,
    ) -> (SVector<Self::Scalar, M>, SMatrix<Self::Scalar, M, N>);

    /// The rounding of g at q, over ε: the sizes of its terms, of whatever origin q is measured from.
    /// Infinite where it is not known.
    #[cold]
    fn constraint_rounding(&self, q: &SVector<Self::Scalar, N>) -> SVector<Self::Scalar, M> {
        let _ = q;
        SVector::repeat(Self::Scalar::constant(f64::INFINITY))
    }

    /// ρ(q, v), and ∂ρ/∂q of shape M×N. A step asks for it where there are constraints of velocity, or
    /// prescribed ones.
    fn constraint_rates(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> (SVector<Self::Scalar, M>, SMatrix<Self::Scalar, M, N>);

    /// ∂(Gᵀλ)/∂q, which derivatives of a step ask for; the step itself does not.
    fn constraint_curvature(
        &self,
        q: &SVector<Self::Scalar, N>,
        lambda: &SVector<Self::Scalar, M>,
    ) -> SMatrix<Self::Scalar, N, N>;
}

/// Derivatives of M constraints by P parameters θ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstraintsBy<S, const N: usize, const M: usize, const P: usize> {
    /// ∂g/∂θ, 0 for constraints of velocity.
    pub values: SMatrix<S, M, P>,
    /// ∂ρ/∂θ.
    pub rates: SMatrix<S, M, P>,
    /// ∂(Gᵀλ)/∂θ.
    pub reaction: SMatrix<S, N, P>,
}

/// Constraints by the P parameters that [`Parameters`](crate::system::Parameters) lists.
pub trait ConstrainedParameters<const N: usize, const M: usize, const P: usize>: Constrained<N, M> {
    /// ∂g/∂θ at q, ∂ρ/∂θ at (q, v) and ∂(Gᵀλ)/∂θ.
    fn constraints_by_parameters(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        lambda: &SVector<Self::Scalar, M>,
    ) -> ConstraintsBy<Self::Scalar, N, M, P>;
}

/// The rows of holonomic constraints, with 0 behind them.
#[inline]
pub fn first_rows<S: Scalar, const H: usize, const M: usize>(values: [S; H]) -> SVector<S, M> {
    let mut rows: SVector<S, M> = nalgebra::zero();
    rows.as_mut_slice().iter_mut().zip(values).for_each(|(row, value)| *row = value);
    rows
}

/// The rows of constraints of velocity, with 0 before them.
#[inline]
pub fn last_rows<S: Scalar, const V: usize, const M: usize>(values: [S; V]) -> SVector<S, M> {
    let mut rows: SVector<S, M> = nalgebra::zero();
    rows.as_mut_slice().iter_mut().skip(M - V.min(M)).zip(values).for_each(|(row, value)| *row = value);
    rows
}

/// Roundings of the terms of gₖ and of its rate that a point on the constraints may be off, given as rounded
/// numbers by whoever computed it.
const ROUNDINGS: f64 = 1024.0;

/// [`Lagrangian::violation`] of a system with constraints: the first one that is NaN or infinite, else the
/// first that (q, v) violates by more than rounding explains, if any.
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
    let ((rates, _), (drift, _)) =
        (system.constraint_rates(q, v), system.constraint_rates(q, &nalgebra::zero()));
    if let Some(lost) = lost(&values, &gradients).or_else(|| lost(&rates, &gradients)) {
        return Some(lost);
    }
    if let Some((constraint, value)) = off(&values, &gradients, q) {
        return Some(Violation::Off { constraint, value: value.widen() });
    }
    let sizes = sizes(&gradients, v) + drift.abs();
    let rounded = rates.as_slice().iter().zip(sizes.as_slice());
    for (constraint, (rate, size)) in rounded.enumerate() {
        if exceeds(*rate, *size) {
            return Some(Violation::Leaving { constraint, rate: rate.widen() });
        }
    }
    None
}

/// The normals of the holonomic constraints at q: [`Lagrangian::normals`] of a system with constraints.
#[cold]
pub fn normals<L, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
) -> Normals<L::Scalar, N>
where
    L: Constrained<N, M> + ?Sized,
{
    let (values, gradients) = system.constraint_gradients(q);
    let rows = gradients.row_iter().map(|row| row.transpose());
    Normals::of(rows.zip(values.iter().copied()).take(M - L::OF_VELOCITY.min(M)))
}

/// The first constraint with a value or a derivative by a coordinate that is NaN or infinite.
#[cold]
pub(crate) fn lost<S: Scalar, const N: usize, const M: usize>(
    values: &SVector<S, M>,
    by_one: &SMatrix<S, M, N>,
) -> Option<Violation> {
    let found = S::component_lost(values.as_slice(), [by_one.as_slice(), by_one.as_slice()]);
    found.map(|(constraint, coordinate)| Violation::NoDerivative { constraint, coordinate })
}

/// The first constraint whose value at q rounding does not explain, or is not known to, with the value.
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

/// Whether rounding of terms of this size does not explain the amount, or one of the two is no number.
fn exceeds<S: Scalar>(amount: S, size: S) -> bool {
    let most = size * (S::EPSILON * S::constant(ROUNDINGS));
    amount.abs() > most || !amount.is_finite() || !most.is_finite()
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
