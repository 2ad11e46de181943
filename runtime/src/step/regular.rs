//! Where ∂²L/∂v² can be inverted: at a point, and beside one where it cannot.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{Scalar, linear};
use crate::step::StepError;
#[cfg(feature = "std")]
use crate::system::derivatives_apart;
use crate::system::{Lagrangian, Quantity};

/// Shares of a coordinate, or of 1 where it is less; entries of ∂²L/∂v² may fall with their squares. L may
/// not be defined so far from q: then the next.
const SHARES: [f64; 3] = [1.0 / 16.0, 1.0 / 256.0, 1.0 / 4096.0];

/// Fails where ∂²L/∂v² is not finite or cannot be inverted.
pub(crate) fn require_regular<S: Scalar, const N: usize>(
    mass_matrix: &SMatrix<S, N, N>,
) -> Result<(), StepError> {
    if let Some(index) = (0..N).find(|&i| mass_matrix.row(i).iter().any(|entry| !entry.is_finite())) {
        return Err(StepError::NonFinite { quantity: Quantity::Derivatives, index });
    }
    linear::require_regular(mass_matrix)
        .map_err(|singular| StepError::DegenerateLagrangian { column: singular.column })
}

/// Whether ∂²L/∂v² can be inverted beside q, at the velocity `v` or one beside it: at q the coordinates are
/// singular then, and not L.
#[cfg(feature = "std")]
#[cold]
#[inline(never)]
pub(super) fn is_regular_beside<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> bool {
    let at = |share: f64, v: &SVector<L::Scalar, N>| {
        require_regular(&derivatives_apart(system, &(q + uneven(q.map(size), share)), v).d22)
    };
    // By rounding alone a matrix that is singular everywhere may pass somewhere: not at all of these.
    let is_regular = |v: &SVector<L::Scalar, N>| {
        let mut sides = 0;
        for side in [1.0, -1.0] {
            for share in SHARES {
                match [1.0, 0.625].map(|part| at(side * share * part, v)) {
                    [Ok(()), Ok(())] => {
                        sides += 1;
                        break;
                    }
                    [Err(StepError::DegenerateLagrangian { .. }), _]
                    | [_, Err(StepError::DegenerateLagrangian { .. })] => return false,
                    _ => {}
                }
            }
        }
        sides > 0
    };
    is_regular(v) || is_regular(&beside_velocity(v))
}

/// Without the standard library nothing looks beside q.
#[cfg(not(feature = "std"))]
#[inline(always)]
pub(super) fn is_regular_beside<L: Lagrangian<N> + ?Sized, const N: usize>(
    _: &L,
    _: &SVector<L::Scalar, N>,
    _: &SVector<L::Scalar, N>,
) -> bool {
    false
}

/// A velocity beside this one.
pub(super) fn beside_velocity<S: Scalar, const N: usize>(v: &SVector<S, N>) -> SVector<S, N> {
    let size = if v.amax() > S::constant(0.0) { v.amax() } else { S::constant(1.0) };
    v + uneven(SVector::repeat(size), 1.0 / 8.0)
}

/// A configuration beside this one.
pub(super) fn beside<S: Scalar, const N: usize>(q: &SVector<S, N>) -> SVector<S, N> {
    q + uneven(q.map(size), SHARES[1])
}

/// |x|, or 1 where it is less.
fn size<S: Scalar>(of: S) -> S {
    let one = S::constant(1.0);
    let size = if of < S::constant(0.0) { -of } else { of };
    if size > one { size } else { one }
}

/// This share of each entry, or more: no two alike, since a point that is symmetric could be singular once
/// more.
fn uneven<S: Scalar, const N: usize>(size: SVector<S, N>, share: f64) -> SVector<S, N> {
    SVector::from_fn(|i, _| {
        size[i]
            * S::constant(share)
            * (S::constant(1.0) + S::constant(i as f64) / S::constant(N as f64 + 1.0))
    })
}
