//! The constraint that is NaN or infinite, or has such a derivative.

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::cause::of_violation;
use crate::step::{Segment, StepError};
use crate::system::{Constrained, Violation, lost, violation};

/// The error of a constraint that has no value or no gradient at (q, v), if one has none.
#[cold]
#[inline(never)]
pub(super) fn undefined<L, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Option<StepError>
where
    L: Constrained<N, M>,
{
    let found = violation::<L, N, M>(system, q, v);
    let found = found.filter(|found| matches!(found, Violation::NoDerivative { .. }))?;
    Some(of_violation(system, q, v, found))
}

/// [`undefined`] where a step on the segment asks its constraints: holonomic ones at its end, those of
/// velocity at the middle, by q as well.
#[cold]
#[inline(never)]
pub(super) fn undefined_on<L, const N: usize, const M: usize>(
    system: &L,
    segment: &Segment<L::Scalar, N>,
) -> Option<StepError>
where
    L: Constrained<N, M>,
{
    let Segment { v, h, .. } = segment;
    let at_end = system.later(*h, |system| undefined::<L, N, M>(system, &segment.end(), v));
    if at_end.is_some() || L::OF_VELOCITY == 0 {
        return at_end;
    }
    let half = L::Scalar::constant(0.5);
    system.later(*h * half, |system| {
        let q = segment.at(half);
        let by_q = |system: &L| {
            let (rates, by_q) = system.constraint_rates(&q, v);
            Some(of_violation(system, &q, v, lost(&rates, &by_q)?))
        };
        undefined::<L, N, M>(system, &q, v).or_else(|| by_q(system))
    })
}
