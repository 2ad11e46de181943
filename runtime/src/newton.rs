//! Newton's method with the analytic matrix, damped where a full step does not lower the residual.
//!
//! Residuals are measured in units of their round-off floor, component by component; see [`rounding`].

use nalgebra::{SMatrix, SVector};

use crate::error::{Quantity, StepError};
use crate::linear::Factors;
use crate::{Report, Scalar};

mod rounding;
use rounding::{ACCEPTED, floor, in_units_of, rounding_floor, worst};

/// The function whose root is sought, less its target: value and matrix of derivatives.
pub(crate) struct Evaluation<S, const N: usize> {
    pub(crate) value: SVector<S, N>,
    pub(crate) matrix: SMatrix<S, N, N>,
}

/// A root, with what the last evaluation gave beside it.
pub(crate) struct Solution<S, T, const N: usize> {
    pub(crate) unknown: SVector<S, N>,
    pub(crate) by_product: T,
    pub(crate) report: Report<S>,
}

/// Newton's method needs a few iterations near a root; damped ones near a fold, or undamped ones from far out on a power
/// law, where each takes off a fixed share, need some dozens.
const MAX_ITERATIONS: u32 = 100;

/// A Newton step that leaves more than this share of the residual calls for a measurement of the rounding.
const SLOW: f64 = 0.25;

/// Solves value(q, v) = target for v.
///
/// `evaluate` gives value and matrix; `finish` the value alone, with the by-product wanted at the root. The residual that
/// the report states is the one that `finish` measured there. `q` is what the value depends on beside v, given to
/// `finish` so that the effect of rounding it can be measured.
#[inline]
pub(crate) fn solve<S: Scalar, T, const N: usize>(
    evaluate: impl Fn(&SVector<S, N>) -> Evaluation<S, N>,
    finish: impl Fn(&SVector<S, N>, &SVector<S, N>) -> (SVector<S, N>, T),
    q: &SVector<S, N>,
    target: &SVector<S, N>,
    guess: SVector<S, N>,
) -> Result<Solution<S, T, N>, StepError> {
    let mut v = guess;
    let mut at_v = evaluate(&v);
    let mut residual = at_v.value - target;
    let mut last_correction = S::zero();
    let mut contraction = S::one();
    let mut damped = 0;

    for iteration in 0..MAX_ITERATIONS {
        let factors = Factors::of(&at_v.matrix).map_err(|singular| {
            match first_non_finite(&residual, &at_v.matrix) {
                Some(index) => StepError::NonFinite { quantity: Quantity::Derivatives, index },
                // Damped descent ends at a singular matrix where the residual has its least value, above 0.
                None if damped > 0 => {
                    StepError::NoRealSolution { iteration, residual: residual.amax().widen() }
                }
                None => StepError::SingularNewtonMatrix { iteration, column: singular.column },
            }
        })?;
        let correction = factors.solve(&residual);
        let floor = floor(target, &at_v.matrix, &(v - correction));
        let size = in_units_of(&residual, &floor);
        if !size.is_finite()
            && let Some(index) = first_non_finite(&residual, &at_v.matrix)
        {
            return Err(StepError::NonFinite { quantity: Quantity::Derivatives, index });
        }

        // Newton's residuals satisfy |r′| ≈ C|r|², so one contraction predicts the next.
        let predicted = contraction * contraction * size;
        if predicted <= S::one() || size <= S::one() {
            let candidate = v - correction;
            let (value, by_product) = finish(q, &candidate);
            let remaining = value - target;
            if in_units_of(&remaining, &floor) <= S::constant(ACCEPTED) {
                let (residual, floor) = worst(&remaining, &floor);
                let report = Report {
                    iterations: iteration + 1,
                    damped,
                    residual,
                    floor,
                    last_correction: correction.amax(),
                };
                return Ok(Solution { unknown: candidate, by_product, report });
            }
        }

        let mut share = S::one();
        loop {
            let candidate = v - correction * share;
            let next = evaluate(&candidate);
            let next_residual = next.value - target;
            let next_size = in_units_of(&next_residual, &floor);
            let falls = next_size < size;
            // Newton's steps contract fast, or not for a reason: rounding is one.
            let fast = next_size < size * S::constant(SLOW);
            if share == S::one() && !fast {
                let (best, size) = if falls { (candidate, next_size) } else { (v, size) };
                if let Some(floor) = rounding_floor(&finish, q, target, &best, &floor, size, falls) {
                    let correction = if falls { correction.amax() } else { last_correction };
                    return Ok(at_floor(
                        finish(q, &best),
                        target,
                        best,
                        &floor,
                        [iteration + 1, damped],
                        correction,
                    ));
                }
            }
            if falls {
                contraction = next_size / size;
                last_correction = (correction * share).amax();
                (v, at_v, residual) = (candidate, next, next_residual);
                break;
            }
            share = shorter(share, size, next_size);
            if is_negligible(&(correction * share), &v) || share < S::EPSILON * S::EPSILON {
                return Err(match first_non_finite(&next_residual, &next.matrix) {
                    Some(index) => StepError::NonFinite { quantity: Quantity::Derivatives, index },
                    None => give_up(iteration, &residual, &floor, &correction, &v),
                });
            }
        }
        damped += u32::from(share < S::one());
    }

    let floor = floor(target, &at_v.matrix, &v);
    let (residual, floor) = worst(&residual, &floor);
    Err(StepError::NotConverged {
        iterations: MAX_ITERATIONS,
        residual: residual.widen(),
        floor: floor.widen(),
    })
}

/// The root at an iterate whose residual rounding keeps above the estimated floor.
#[cold]
fn at_floor<S: Scalar, T, const N: usize>(
    (value, by_product): (SVector<S, N>, T),
    target: &SVector<S, N>,
    v: SVector<S, N>,
    floor: &SVector<S, N>,
    [iterations, damped]: [u32; 2],
    last_correction: S,
) -> Solution<S, T, N> {
    let (residual, floor) = worst(&(value - target), floor);
    let report = Report { iterations, damped, residual, floor, last_correction };
    Solution { unknown: v, by_product, report }
}

/// A share of the Newton step to try after `share` gave `next_size` ≥ `size`: where (1 − s) + C s², the residual's first
/// two terms along the step, is least; between a tenth and a half of the present share.
#[cold]
fn shorter<S: Scalar>(share: S, size: S, next_size: S) -> S {
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

/// Tells a residual that lost digits hold up from one that has no root.
#[cold]
fn give_up<S: Scalar, const N: usize>(
    iteration: u32,
    residual: &SVector<S, N>,
    floor: &SVector<S, N>,
    correction: &SVector<S, N>,
    v: &SVector<S, N>,
) -> StepError {
    // Near a fold the matrix is almost singular and the correction large; lost digits leave it small.
    if is_below(S::EPSILON.cbrt(), correction, v) {
        let (residual, floor) = worst(residual, floor);
        StepError::LostPrecision { residual: residual.widen(), floor: floor.widen() }
    } else {
        StepError::NoRealSolution { iteration, residual: residual.amax().widen() }
    }
}

#[cold]
fn first_non_finite<S: Scalar, const N: usize>(
    residual: &SVector<S, N>,
    matrix: &SMatrix<S, N, N>,
) -> Option<usize> {
    (0..N).find(|&i| !residual[i].is_finite() || matrix.row(i).iter().any(|entry| !entry.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;

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
