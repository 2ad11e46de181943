//! Newton's method with the analytic matrix.
//!
//! Nearly every step is solved by the undamped method in two or three iterations ([`quick`]). Where that does not contract,
//! the residual is held up by rounding, far from a root, or without one: [`careful`] damps it and tells these apart.
//!
//! Residuals are measured in units of their round-off floor, component by component; [`rounding`] defines when a step is solved.
//! Descent of the residual alone would refuse good iterates: the residual of a coordinate at rest, without a force as yet, has a
//! floor near 0, and that of a stiff spring grows with the square of a long sideways step. An iterate is therefore taken as well
//! where the Newton step still to take from it is shorter ([`nearer`]; compare P. Deuflhard, Newton Methods for Nonlinear
//! Problems, 2004, on tests in the unknowns).

use nalgebra::{SMatrix, SVector};

use crate::discrete::{Momenta, StepKernel};
use crate::error::{Quantity, StepError};
use crate::linear::{NewtonMatrix, Singular};
use crate::{Report, Scalar, State};

mod bounded;
mod rounding;
mod start;
mod verdict;
pub(crate) use bounded::bounded;
pub(crate) use rounding::{
    AT_FLOOR, PLACES, SLOW, SMALL, estimated_floor, finite_part, held_against, held_by_weights, is_sensible,
};
use rounding::{in_units_of, worst};
pub(crate) use start::{from_rest, is_rest};
pub(crate) use verdict::Equations;
use verdict::{stagnated, verified};

/// A root, with both momenta there.
pub(crate) struct Solution<S, const N: usize> {
    pub(crate) unknown: SVector<S, N>,
    pub(crate) momenta: Momenta<S, N>,
    pub(crate) report: Report<S>,
}

/// Newton's method needs a few iterations near a root; damped ones near a fold, or undamped ones from far out on a power
/// law, where each takes off a fixed share, need some dozens.
const MAX_ITERATIONS: u32 = 100;

/// Once the step has been shortened below this share, a singular matrix is reported instead of stepped around.
const SHORTEST: f64 = 1e-3;

/// The undamped method's iterations: from a guess this far off the careful one goes on.
const QUICK_ITERATIONS: u32 = 8;

/// An iterate, the Newton step from it, and the measure of its residual.
struct Iterate<S, M, const N: usize> {
    v: SVector<S, N>,
    residual: SVector<S, N>,
    matrix: M,
    /// The full Newton step leads to v − correction.
    correction: SVector<S, N>,
    floor: SVector<S, N>,
    /// max |residualᵢ|/floorᵢ.
    size: S,
}

/// What is known of the equation p0(q, v) = p before it is solved.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Equation {
    /// Linear in v: the first correction leads to the root.
    Linear,
    /// Nothing.
    General,
}

/// Solves p0(q, v) = p for v at the `state` (q, p).
///
/// `evaluate` gives p0 and the Newton matrix, `finish` both momenta, `inertia` the mass matrix, the metric that tells which of
/// two velocities is longer; configurations on the way are q plus a share of `h` v, with h = 0 at q itself. The residual that the
/// report states is the one that `finish` measured at the root.
///
/// Functions by reference: with `F = &G` for one of them, calls of it would not be inlined where `F` is behind a pointer as well.
#[inline]
pub(crate) fn solve<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    kind: Equation,
    evaluate: &impl Fn(&SVector<S, N>, &SVector<S, N>) -> StepKernel<S, N, M>,
    finish: &impl Fn(&SVector<S, N>, &SVector<S, N>) -> Momenta<S, N>,
    inertia: &impl Fn(&SVector<S, N>, &SVector<S, N>) -> SMatrix<S, N, N>,
    state: &State<S, N>,
    h: S,
    guess: SVector<S, N>,
) -> Result<Solution<S, N>, StepError> {
    match quick(kind, evaluate, finish, state, guess) {
        Ok(solution) => Ok(solution),
        Err(reached) => {
            let of = Equations { evaluate, finish, inertia, state, h };
            careful(&of, reached)
        }
    }
}

/// Where the undamped method left off: the last iterate that lowered the residual, and the corrections that led there.
struct Reached<S, const N: usize> {
    v: SVector<S, N>,
    iterations: u32,
}

/// The undamped method, as long as it contracts as Newton's does.
///
/// Newton's residuals fall as |r′| ≈ C|r|², so the last contraction c predicts the next one, c². Where that ends at the
/// floor, the matrix is not needed again. On the way residuals are weighed by the floor at the guess; the root is held
/// against its own.
#[inline]
#[expect(clippy::neg_cmp_op_on_partial_ord, reason = "a contraction that is NaN must fail the comparison")]
fn quick<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    kind: Equation,
    evaluate: &impl Fn(&SVector<S, N>, &SVector<S, N>) -> StepKernel<S, N, M>,
    finish: &impl Fn(&SVector<S, N>, &SVector<S, N>) -> Momenta<S, N>,
    state: &State<S, N>,
    guess: SVector<S, N>,
) -> Result<Solution<S, N>, Reached<S, N>> {
    let State { q, p } = state;
    let mut v = guess;
    let mut weights: SVector<S, N> = nalgebra::zero();
    let mut last_size = S::zero();
    let mut reached = Reached { v, iterations: 0 };
    for iterations in 0..QUICK_ITERATIONS {
        let kernel = evaluate(q, &v);
        let residual = kernel.p0 - p;
        let Ok(correction) = kernel.matrix.solve(&residual) else { break };
        let next = v - correction;
        let close = if kind == Equation::Linear {
            true
        } else if iterations == 0 {
            weights = estimated_floor(p, &kernel.matrix, &next).map(|floor| S::one() / floor);
            last_size = weighted(&residual, &weights);
            last_size <= S::one()
        } else {
            let size = weighted(&residual, &weights);
            let contraction = size / last_size;
            if !(contraction <= S::constant(SLOW)) {
                break;
            }
            last_size = size;
            size <= S::one() || contraction * contraction * size <= S::one()
        };
        reached = Reached { v, iterations };
        v = next;
        if close {
            let momenta = finish(q, &v);
            let residual = momenta.p0 - p;
            let floor = estimated_floor(p, &kernel.matrix, &v);
            let (residual, floor, is_root) = held_against(&residual, &floor);
            let last_correction = largest(&correction);
            if is_root && (kind == Equation::Linear || is_known_at(&v, last_correction)) {
                let iterations = iterations + 1;
                let report = Report { iterations, damped: 0, residual, floor, last_correction };
                return Ok(Solution { unknown: v, momenta, report });
            }
        }
    }
    Err(reached)
}

/// Whether the floor at `v` may be taken from the matrix of the iterate before, from which the `last_correction` led here: from a
/// guess that is far out by many orders of magnitude that matrix can be larger by as many, and with it the floor.
#[inline(always)]
fn is_known_at<S: Scalar, const N: usize>(v: &SVector<S, N>, last_correction: S) -> bool {
    last_correction <= largest(v) * S::constant(SMALL)
}

/// max |vᵢ|; a loop of its own, which optimisation for size leaves one.
#[inline(always)]
fn largest<S: Scalar, const N: usize>(v: &SVector<S, N>) -> S {
    let mut largest = S::zero();
    for entry in v.as_slice() {
        let size = entry.abs();
        largest = if size > largest { size } else { largest };
    }
    largest
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

/// The damped method, and the verdicts.
#[cold]
#[inline(never)]
fn careful<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    of: &Equations<'_, S, M, N>,
    reached: Reached<S, N>,
) -> Result<Solution<S, N>, StepError> {
    let Equations { evaluate, state: State { q, p }, .. } = of;
    let mut trial = reached.v;
    let mut share = S::one();
    let mut contraction = S::one();
    let mut iterations = reached.iterations;
    let mut damped = 0;
    let mut iterate: Option<Iterate<S, M, N>> = None;

    loop {
        let kernel = evaluate(q, &trial);
        let residual = kernel.p0 - p;
        if let Some(last) = &iterate {
            let size = in_units_of(&residual, &last.floor);
            let lower = size < last.size;
            // A contraction that is none, or that is no longer Newton's, may be rounding, unless the next step is a shorter one.
            let slow = share == S::one() && !(lower && size <= last.size * S::constant(SLOW));
            let nearer = slow && nearer(&kernel, of, last);
            if slow
                && !nearer
                && let Some(solution) =
                    stagnated(of, last, (&trial, &kernel.matrix, lower), [iterations, damped])
            {
                return Ok(solution);
            }
            if !lower && !nearer {
                share = shorter(share, last.size, size);
                let change = last.correction * share;
                if is_negligible(&change, &last.v) || share < S::EPSILON * S::EPSILON {
                    return Err(match first_non_finite(&residual, &kernel.matrix) {
                        Some(index) => StepError::NonFinite { quantity: Quantity::Derivatives, index },
                        None => give_up(iterations, last),
                    });
                }
                trial = last.v - change;
                continue;
            }
            damped += u32::from(share < S::one());
            // Unknown where the residual says nothing.
            contraction = if lower { size / last.size } else { S::one() };
        }

        let correction = match (kernel.matrix.solve(&residual), &iterate) {
            (Ok(correction), _) => correction,
            // The matrix is singular along the way only; a shorter step leads elsewhere.
            (Err(_), Some(last))
                if share > S::constant(SHORTEST) && first_non_finite(&residual, &kernel.matrix).is_none() =>
            {
                // It was no iterate: nothing is corrected from it.
                damped -= u32::from(share < S::one());
                share *= S::constant(0.5);
                trial = last.v - last.correction * share;
                continue;
            }
            (Err(singular), _) => {
                return Err(unsolvable(singular, &residual, &kernel.matrix, iterations, damped));
            }
        };
        let v = trial;
        trial = v - correction;
        let floor = estimated_floor(p, &kernel.matrix, &trial);
        let size = in_units_of(&residual, &floor);
        if !size.is_finite()
            && let Some(index) = first_non_finite(&residual, &kernel.matrix)
        {
            return Err(StepError::NonFinite { quantity: Quantity::Derivatives, index });
        }
        if iterations >= MAX_ITERATIONS {
            let (residual, floor) = worst(&residual, &floor);
            return Err(StepError::NotConverged {
                iterations,
                residual: residual.widen(),
                floor: floor.widen(),
            });
        }
        iterations += 1;

        if size <= S::one() || contraction * contraction * size <= S::one() {
            // The matrix at the root itself: that of an iterate far out can be larger by many orders of magnitude.
            let matrix = evaluate(q, &trial).matrix;
            if let Some(solution) =
                verified(of, &trial, &matrix, largest(&correction), [iterations, damped], false)
            {
                return Ok(solution);
            }
        }
        share = S::one();
        iterate = Some(Iterate { v, residual, matrix: kernel.matrix, correction, floor, size });
    }
}

/// Whether a full step whose residual is no lower is nearer to the root all the same: the Newton step from there is at most
/// half as long, with Σ |Mᵢᵢ| vᵢ² for the square of a length, by a matrix that has not grown.
///
/// Neither the units of a coordinate nor a stiff direction that turns, nor a component that was 0, change this verdict. With one
/// coordinate it is that of the residual.
#[cold]
fn nearer<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    trial: &StepKernel<S, N, M>,
    Equations { inertia, state: State { q, p }, .. }: &Equations<'_, S, M, N>,
    last: &Iterate<S, M, N>,
) -> bool {
    let Ok(next) = trial.matrix.solve(&(trial.p0 - p)) else { return false };
    let before = &last.matrix;
    if (0..N).any(|i| trial.matrix.entry(i, i).abs() > before.entry(i, i).abs() * S::constant(2.0)) {
        return false;
    }
    let inertia = inertia(q, &last.v).diagonal().abs();
    let square = |v: &SVector<S, N>| v.component_mul(v).dot(&inertia);
    square(&next) < square(&last.correction) * S::constant(0.25)
}

/// What a Newton matrix that cannot be solved with means.
#[cold]
fn unsolvable<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    singular: Singular,
    residual: &SVector<S, N>,
    matrix: &M,
    iteration: u32,
    damped: u32,
) -> StepError {
    match first_non_finite(residual, matrix) {
        Some(index) => StepError::NonFinite { quantity: Quantity::Derivatives, index },
        // Damped descent ends at a singular matrix where the residual has its least value, above 0.
        None if damped > 0 => StepError::NoRealSolution { iteration, residual: residual.amax().widen() },
        None => StepError::SingularNewtonMatrix { iteration, column: singular.column },
    }
}

/// A share of the Newton step to try after `share` gave `next_size` ≥ `size`: where (1 − s) + C s², the residual's first
/// two terms along the step, is least; between a tenth and a half of the present share.
#[cold]
pub(crate) fn shorter<S: Scalar>(share: S, size: S, next_size: S) -> S {
    let curvature = (next_size / size - S::one() + share) / (share * share);
    let least = S::constant(0.5) / curvature;
    let (tenth, half) = (share * S::constant(0.1), share * S::constant(0.5));
    // Not finite where the step left the domain of L, R or f: `least` is 0 or NaN, and fails the comparison.
    if least > tenth { if least < half { least } else { half } } else { tenth }
}

/// Whether adding `change` to `v` makes no difference worth a step.
fn is_negligible<S: Scalar, const N: usize>(change: &SVector<S, N>, v: &SVector<S, N>) -> bool {
    is_below(S::EPSILON.sqrt(), change, v)
}

fn is_below<S: Scalar, const N: usize>(factor: S, change: &SVector<S, N>, v: &SVector<S, N>) -> bool {
    (0..N).all(|i| change[i].abs() <= factor * v[i].abs())
}

/// Tells a residual that rounding holds up from one that has no root.
#[cold]
fn give_up<S: Scalar, M, const N: usize>(iteration: u32, last: &Iterate<S, M, N>) -> StepError {
    // Near a fold the matrix is almost singular and the correction large; lost digits leave it small.
    if is_below(S::EPSILON.cbrt(), &last.correction, &last.v) {
        let (residual, floor) = worst(&last.residual, &last.floor);
        StepError::LostPrecision { residual: residual.widen(), floor: floor.widen() }
    } else {
        StepError::NoRealSolution { iteration, residual: last.residual.amax().widen() }
    }
}

#[cold]
fn first_non_finite<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    residual: &SVector<S, N>,
    matrix: &M,
) -> Option<usize> {
    (0..N).find(|&i| !residual[i].is_finite() || !matrix.row_is_finite(i))
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

    #[test]
    fn a_shorter_share_lies_where_the_residual_is_least() {
        // (1 − s) + 2s²: 2 at s = 1, least at ¼.
        assert_eq!(shorter(1.0, 1.0, 2.0), 0.25);
        // From the share ½, where it is 1, the same.
        assert_eq!(shorter(0.5, 1.0, 1.0), 0.25);
        // Within a tenth and a half of the present share; the least of them where the step left the domain.
        assert_eq!(shorter(1.0, 1.0, 1.0), 0.5);
        assert_eq!(shorter(1.0, 1.0, 1e9), 0.1);
        assert_eq!(shorter(0.5, 1.0, f64::INFINITY), 0.05);
        assert_eq!(shorter(0.5, 1.0, f64::NAN), 0.05);
    }
}
