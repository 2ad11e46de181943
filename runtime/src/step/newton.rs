//! Newton's method with the analytic matrix.
//!
//! Nearly every step is solved by the undamped method in two or three iterations ([`quick`]). Where that does
//! not contract, the residual is held up by rounding, far from a root, or without one, it is damped,
//! and these are told apart; a step that finds no root from the state alone is led to it in parts of h: at
//! length, by [`nonlinear`](crate::numbers::nonlinear).
//!
//! Residuals are measured in units of their round-off floor, component by component; [`rounding`] defines
//! when a step is solved. Descent of the residual alone would refuse good iterates: the residual of a
//! coordinate at rest, without a force as yet, has a floor near 0, and that of a stiff spring grows with the
//! square of a long sideways step. An iterate is therefore taken as well where the Newton step still to take
//! from it is shorter (`nearer`; compare P. Deuflhard, Newton Methods for Nonlinear Problems,
//! 2004, on tests in the unknowns).

use nalgebra::SVector;

use crate::numbers::{NewtonMatrix, Scalar};
pub(crate) use crate::step::equation::Equation;
use crate::step::equation::StepEquation;
use crate::step::{Momenta, Report, Segment, State, StepError};

mod at_length;
mod bounded;
mod rounding;
pub(crate) use crate::numbers::nonlinear::{
    AT_FLOOR, ITERATIONS, PLACES, SLOW, SMALL, add_finite_part, is_sensible, shorter,
};
use crate::numbers::nonlinear::{Room, Unsolved, Way, largest};
use crate::numbers::slices::{vector, write};
pub(crate) use at_length::{NotSolved, StepProblem};
pub(crate) use bounded::bounded;
pub(crate) use rounding::{estimated_floor, held_against, held_by_weights, is_small_beside};

/// A root, with both momenta there.
pub(crate) struct Solution<S, const N: usize> {
    pub(crate) unknown: SVector<S, N>,
    pub(crate) momenta: Momenta<S, N>,
    pub(crate) report: Report<S>,
}

/// The undamped method's iterations: from a guess this far off the careful one goes on.
pub(crate) const QUICK_ITERATIONS: u32 = 8;

/// The v with momentum(q, v) = p at the `state` (q, p). Configurations on the way are q plus a share of `h`
/// v, with h = 0 at q itself.
#[cfg(feature = "theory")]
#[inline]
pub(crate) fn root<S: Scalar, const N: usize>(
    equation: &impl StepEquation<S, N>,
    state: &State<S, N>,
    h: S,
    start: SVector<S, N>,
) -> Result<SVector<S, N>, StepError> {
    match quick(equation, state, h, start) {
        Ok(solution) => Ok(solution.unknown),
        Err(Reached { v, iterations }) => root_by(Way::Damped { iterations }, equation, (state, h), &v),
    }
}

/// The root of an equation alone, from rest by the damped method. Where that has led to an `error`, a matrix
/// that is singular there or not finite, from away from rest.
pub(crate) fn root_from_rest<S: Scalar, const N: usize>(
    equation: &impl StepEquation<S, N>,
    state: &State<S, N>,
    error: Option<StepError>,
) -> Result<SVector<S, N>, StepError> {
    let way = match error {
        None => Way::Damped { iterations: 0 },
        Some(StepError::NonFinite { index, .. }) => Way::FromRest { error: Unsolved::NonFinite { index } },
        Some(StepError::DegenerateLagrangian { column }) => {
            Way::FromRest { error: Unsolved::Singular { iteration: 0, column } }
        }
        Some(other) => return Err(other),
    };
    root_by(way, equation, (state, S::zero()), &nalgebra::zero())
}

/// The root of an equation alone, at length by this way.
fn root_by<S: Scalar, const N: usize>(
    way: Way<'_, S>,
    equation: &impl StepEquation<S, N>,
    (state, h): (&State<S, N>, S),
    start: &SVector<S, N>,
) -> Result<SVector<S, N>, StepError> {
    let of = StepProblem { equation, state, h };
    Ok(of.solved(way, start).map_err(|lost| lost.error)?.unknown)
}

/// Whether the `residual` vanishes with the velocity in every coordinate, so that rest is its root.
#[cold]
pub(crate) fn is_rest<S: Scalar, const N: usize>(
    residual: &dyn Fn(&SVector<S, N>) -> SVector<S, N>,
    p: &SVector<S, N>,
) -> bool {
    let residual = &mut |v: &[S], into: &mut [S]| {
        write(into, &residual(&vector(v)));
    };
    S::is_rest(residual, p.as_slice(), Room::new(at_length::room::<S, N>().as_flattened_mut(), N))
}

/// Where the undamped method left off: the last iterate that lowered the residual, and the corrections that
/// led there.
pub(crate) struct Reached<S, const N: usize> {
    pub(crate) v: SVector<S, N>,
    pub(crate) iterations: u32,
}

/// The undamped method, as long as it contracts as Newton's does.
///
/// Newton's residuals fall as |r′| ≈ C|r|², so the last contraction c predicts the next one, c². Where that
/// ends at the floor, the matrix is not needed again. Contractions that stay as they are, are those of
/// rounding: at rest h v̄ may be less than the last place of q, which forces then do not see. On the way
/// residuals are weighed by the floor at the guess; the root is held against its own.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn quick<S: Scalar, const N: usize>(
    equation: &impl StepEquation<S, N>,
    state: &State<S, N>,
    h: S,
    guess: SVector<S, N>,
) -> Result<Solution<S, N>, Reached<S, N>> {
    let (p, kind) = (&state.p, equation.kind());
    // One segment in its place, whose v̄ alone moves: none is copied from iteration to iteration.
    let mut segment = Segment { q0: state.q, v: guess, h };
    let mut weights: SVector<S, N> = nalgebra::zero();
    let (mut last_size, mut slow) = (S::zero(), S::constant(SLOW));
    let mut reached = Reached { v: guess, iterations: 0 };
    for iterations in 0..QUICK_ITERATIONS {
        let kernel = equation.kernel(&segment);
        let residual = kernel.p0 - p;
        let correction = match equation.correction(&residual) {
            Some(correction) => correction,
            None => match kernel.matrix.solve(&residual) {
                Ok(correction) => correction,
                Err(_) => break,
            },
        };
        let next = segment.v - correction;
        let close = if kind == Equation::Linear {
            true
        } else if iterations == 0 {
            let floor = equation.floor(estimated_floor(p, &kernel.matrix, &next));
            weights = floor.map(|floor| S::one() / floor);
            last_size = weighted(&residual, &weights);
            last_size <= S::one()
        } else {
            let size = weighted(&residual, &weights);
            let contraction = size / last_size;
            let is_slow_at_floor = size <= S::one() && contraction <= S::constant(SLOW);
            // A contraction that is NaN is none.
            if !(contraction <= slow || is_slow_at_floor) {
                break;
            }
            (last_size, slow) = (size, contraction * S::constant(0.5));
            size <= S::one() || contraction * contraction * size <= S::one()
        };
        reached = Reached { v: segment.v, iterations };
        segment.v = next;
        if close {
            let momenta = equation.momenta(&segment);
            let left = momenta.p0 - p;
            let floor = equation.floor(estimated_floor(p, &kernel.matrix, &segment.v));
            let (residual, floor, is_root) = held_against(&left, &floor);
            if is_root && (is_small_beside(&left, p) || is_known_at(kind, &segment.v, &correction)) {
                let iterations = iterations + 1;
                let last_correction = largest(correction.as_slice());
                let report = Report { iterations, damped: 0, residual, floor, last_correction };
                return Ok(Solution { unknown: segment.v, momenta, report });
            }
        }
    }
    Err(reached)
}

/// Whether the floor at `v` may be taken from the matrix of the iterate before, from which the last
/// `correction` led here: from a guess that is far out by many orders of magnitude, be it in one coordinate,
/// that matrix can be larger by as many, and with it the floor. That of a linear equation is one everywhere.
#[cfg_attr(not(debug_assertions), inline(always))]
fn is_known_at<S: Scalar, const N: usize>(
    kind: Equation,
    v: &SVector<S, N>,
    correction: &SVector<S, N>,
) -> bool {
    let mut is_known = true;
    for i in 0..N {
        is_known &= correction[i].abs() <= v[i].abs() * S::constant(SMALL);
    }
    is_known || kind == Equation::Linear
}

/// max |residualᵢ| weightᵢ; NaN if one of them is no finite number.
#[inline]
pub(crate) fn weighted<S: Scalar, const N: usize>(residual: &SVector<S, N>, weights: &SVector<S, N>) -> S {
    const LANES: usize = 4;
    let (mut largest, mut sums) = ([S::zero(); LANES], [S::zero(); LANES]);
    // Lane by lane, the compiler takes several at once.
    let (of, rest_of) = residual.as_slice().as_chunks::<LANES>();
    let (by, rest_by) = weights.as_slice().as_chunks::<LANES>();
    for (of, by) in of.iter().zip(by) {
        for lane in 0..LANES {
            let units = of[lane].abs() * by[lane];
            sums[lane] += units;
            largest[lane] = if units > largest[lane] { units } else { largest[lane] };
        }
    }
    for (of, by) in rest_of.iter().zip(rest_by) {
        let units = of.abs() * *by;
        sums[0] += units;
        largest[0] = if units > largest[0] { units } else { largest[0] };
    }
    let (mut size, mut sum) = (S::zero(), S::zero());
    for lane in 0..LANES {
        sum += sums[lane];
        size = if largest[lane] > size { largest[lane] } else { size };
    }
    // 0 × sum is 0 for every finite sum, and NaN for the others.
    size + sum * S::zero()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weighted_residual_is_the_largest_or_no_number() {
        let weights = SVector::from([1.0, 2.0, 0.5, 1.0, 4.0, 1.0]);
        for (i, expected) in [3.0, 6.0, 1.5, 3.0, 12.0, 3.0].into_iter().enumerate() {
            let mut residual = SVector::from_element(0.25);
            residual[i] = -3.0;
            assert_eq!(weighted(&residual, &weights), expected);
            for lost in [f64::NAN, f64::INFINITY] {
                residual[i] = lost;
                assert!(weighted(&residual, &weights).is_nan());
            }
        }
    }
}
