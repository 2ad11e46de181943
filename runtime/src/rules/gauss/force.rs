//! f_d with its derivatives.
//!
//! Of D²L_d and Df_d alone their sums K are exact; Df_d itself holds second derivatives of the interior
//! points, that is third ones of L, and is a central difference of order 8 of f_d. Without force it is 0 and
//! D²L_d exact.

use nalgebra::SVector;

use super::segment::Segment;
use crate::numbers::{CovectorDerivatives, Scalar};
use crate::step::{DiscreteForce, DiscreteForceDerivatives};
use crate::system::ForcedLagrangian;

/// f_d on the segment (q0, q1), NaN where it has no solution.
pub(super) fn force<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    system: &L,
    q0: &SVector<T, N>,
    q1: &SVector<T, N>,
    h: T,
) -> DiscreteForce<T, N> {
    if !L::IS_FORCED {
        return DiscreteForce::zero();
    }
    let solved = Segment::<'_, L, N, S>::new(system, q0, &((q1 - q0) / h), h);
    let force = solved.and_then(|segment| Ok(segment.force(&segment.variations()?)));
    let nan = SVector::repeat(T::constant(f64::NAN));
    force.unwrap_or(DiscreteForce { minus: nan, plus: nan })
}

/// Weights of the central difference of order 8, for ±1, ±2, ±3, ±4 spacings.
const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Spacings tried, as powers of 2 of the coordinate's size.
const SPACINGS: core::ops::RangeInclusive<i32> = 2..=11;

/// f_d with its derivatives: along each coordinate by the spacing whose result changes least when it is
/// halved.
pub(super) fn force_derivatives<
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T>,
    const N: usize,
    const S: usize,
>(
    system: &L,
    q0: &SVector<T, N>,
    q1: &SVector<T, N>,
    h: T,
) -> DiscreteForceDerivatives<T, N> {
    let value = force::<T, L, N, S>(system, q0, q1, h);
    let mut derivatives = DiscreteForceDerivatives::zero();
    (derivatives.minus.value, derivatives.plus.value) = (value.minus, value.plus);
    if !L::IS_FORCED {
        return derivatives;
    }
    for a in 0..N {
        let size = q0[a].abs().max(q1[a].abs());
        let size = if size > T::zero() { size } else { T::one() };
        for moves_end in [false, true] {
            let difference = |spacing: T| {
                let at = |multiple: f64| {
                    let (mut q0, mut q1) = (*q0, *q1);
                    let moved = if moves_end { &mut q1 } else { &mut q0 };
                    moved[a] += spacing * T::constant(multiple);
                    force::<T, L, N, S>(system, &q0, &q1, h)
                };
                (1..).zip(WEIGHTS).fold(DiscreteForce::zero(), |sum, (multiple, weight)| {
                    let multiple = f64::from(multiple);
                    let odd = at(multiple) + at(-multiple) * -T::one();
                    sum + odd * (T::constant(weight) / spacing)
                })
            };
            let mut least: Option<(T, DiscreteForce<T, N>)> = None;
            let mut wide = difference(size * T::constant(0.5).powi(*SPACINGS.start()));
            for power in SPACINGS {
                let narrow = difference(size * T::constant(0.5).powi(power + 1));
                let spread = (narrow.minus - wide.minus).amax().max((narrow.plus - wide.plus).amax());
                let is_less = least.as_ref().is_none_or(|(known, _)| spread < *known || !known.is_finite());
                if is_less && spread.is_finite() {
                    least = Some((spread, narrow));
                }
                wide = narrow;
            }
            let nan = SVector::repeat(T::constant(f64::NAN));
            let column = least.map_or(DiscreteForce { minus: nan, plus: nan }, |(_, column)| column);
            let write = |of: &mut CovectorDerivatives<T, N>, column: &SVector<T, N>| {
                if moves_end { of.d2.set_column(a, column) } else { of.d1.set_column(a, column) }
            };
            write(&mut derivatives.minus, &column.minus);
            write(&mut derivatives.plus, &column.plus);
        }
    }
    derivatives
}
