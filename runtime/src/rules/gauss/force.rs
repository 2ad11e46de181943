//! f_d with its derivatives.
//!
//! Of D²L_d and Df_d alone their sums K are exact; Df_d itself holds second derivatives of the interior
//! points, that is third ones of L, and is a central difference of order 8 of f_d. Without force it is 0 and
//! D²L_d exact.

use super::segment::SolvedSegment;
use crate::numbers::{CovectorDerivatives, Scalar};
use crate::step::{DiscreteForce, DiscreteForceDerivatives, DiscreteObjects, Quantity, Segment, StepError};
use crate::system::ForcedLagrangian;
use nalgebra::SVector;

/// Weights of the central difference of order 8, for ±1, ±2, ±3, ±4 spacings.
const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Spacings tried, as powers of 2 of the coordinate's size.
const SPACINGS: core::ops::RangeInclusive<i32> = 2..=11;

/// f_d with its derivatives: along each coordinate by the spacing whose result changes least when it is
/// halved.
pub(super) fn derivatives<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    solved: &SolvedSegment<'_, L, N, S>,
) -> Result<DiscreteForceDerivatives<T, N>, StepError> {
    let value = solved.discrete_force()?;
    let mut derivatives = DiscreteForceDerivatives::zero();
    (derivatives.minus.value, derivatives.plus.value) = (value.minus, value.plus);
    if !L::IS_FORCED {
        return Ok(derivatives);
    }
    let (segment, system) = (solved.segment(), solved.problem.system);
    for a in 0..N {
        let size = segment.q0[a].abs().max(segment.end()[a].abs());
        let size = if size > T::zero() { size } else { T::one() };
        for moves_end in [false, true] {
            let at = |distance: T| {
                let (mut q0, mut q1) = (segment.q0, segment.end());
                let moved = if moves_end { &mut q1 } else { &mut q0 };
                moved[a] += distance;
                let moved = Segment::between(&q0, &q1, segment.h);
                SolvedSegment::<'_, L, N, S>::new(system, &moved)?.discrete_force()
            };
            let difference = |spacing: T| {
                (1..).zip(WEIGHTS).try_fold(DiscreteForce::zero(), |sum, (multiple, weight)| {
                    let distance = spacing * T::constant(f64::from(multiple));
                    let odd = at(distance)? + at(-distance)? * -T::one();
                    Ok(sum + odd * (T::constant(weight) / spacing))
                })
            };
            let column = least_changing(size, difference)?;
            let write = |of: &mut CovectorDerivatives<T, N>, column: &SVector<T, N>| {
                if moves_end { of.d2.set_column(a, column) } else { of.d1.set_column(a, column) }
            };
            write(&mut derivatives.minus, &column.minus);
            write(&mut derivatives.plus, &column.plus);
        }
    }
    Ok(derivatives)
}

/// The difference that changes least when its spacing is halved, of spacings that are shares of `size`.
fn least_changing<T: Scalar, const N: usize>(
    size: T,
    difference: impl Fn(T) -> Result<DiscreteForce<T, N>, StepError>,
) -> Result<DiscreteForce<T, N>, StepError> {
    let half = T::constant(0.5);
    let mut least: Option<(T, DiscreteForce<T, N>)> = None;
    let mut wide = difference(size * half.powi(*SPACINGS.start()));
    for power in SPACINGS {
        let narrow = difference(size * half.powi(power + 1));
        // Beside the segment there may be none.
        if let (Ok(wide), Ok(narrow)) = (&wide, &narrow) {
            let spread = (narrow.minus - wide.minus).amax().max((narrow.plus - wide.plus).amax());
            let is_less = least.as_ref().is_none_or(|(known, _)| spread < *known || !known.is_finite());
            if is_less && spread.is_finite() {
                least = Some((spread, *narrow));
            }
        }
        wide = narrow;
    }
    match least {
        Some((_, column)) => Ok(column),
        None => Err(wide.err().unwrap_or(StepError::NonFinite { quantity: Quantity::Derivatives, index: 0 })),
    }
}
