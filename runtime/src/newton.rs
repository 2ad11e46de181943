//! Newton's method with the analytic matrix, damped where a full step does not lower the residual.
//!
//! Residuals are measured in units of their round-off floor, component by component; see [`rounding`].

use nalgebra::SVector;

use crate::discrete::{Momenta, StepKernel};
use crate::error::{Quantity, StepError};
use crate::linear::{NewtonMatrix, Singular};
use crate::{Report, Scalar, State};

mod rounding;
use rounding::{AT_FLOOR, STAGNATION, estimated_floor, in_units_of, rounding, worst};

/// A root, with both momenta there.
pub(crate) struct Solution<S, const N: usize> {
    pub(crate) unknown: SVector<S, N>,
    pub(crate) momenta: Momenta<S, N>,
    pub(crate) report: Report<S>,
}

/// Newton's method needs a few iterations near a root; damped ones near a fold, or undamped ones from far out on a power
/// law, where each takes off a fixed share, need some dozens.
const MAX_ITERATIONS: u32 = 100;

/// A contraction above this is not that of Newton's method: rounding slows it, or the root is far.
const SLOW: f64 = 0.25;

/// Both momenta as a function of (q, v); behind a pointer where it is called seldom.
type Finish<'f, S, const N: usize> = dyn Fn(&SVector<S, N>, &SVector<S, N>) -> Momenta<S, N> + 'f;

/// An iterate, the Newton step from it, and the measure of its residual.
struct Iterate<S, const N: usize> {
    v: SVector<S, N>,
    residual: SVector<S, N>,
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
/// `evaluate` gives p0 and the Newton matrix, `finish` both momenta. The residual that the report states is the one that
/// `finish` measured at the root.
#[inline]
pub(crate) fn solve<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    kind: Equation,
    evaluate: impl Fn(&SVector<S, N>, &SVector<S, N>) -> StepKernel<S, N, M>,
    finish: impl Fn(&SVector<S, N>, &SVector<S, N>) -> Momenta<S, N>,
    state: &State<S, N>,
    guess: SVector<S, N>,
) -> Result<Solution<S, N>, StepError> {
    let State { q, p } = state;
    let mut trial = guess;
    let mut share = S::one();
    let mut contraction = S::one();
    let mut iterations = 0;
    let mut damped = 0;
    let mut iterate: Option<Iterate<S, N>> = None;

    loop {
        let kernel = evaluate(q, &trial);
        let residual = kernel.p0 - p;
        if let Some(last) = &iterate {
            let size = in_units_of(&residual, &last.floor);
            let lower = size < last.size;
            // A contraction that is none, or that is no longer Newton's, may be rounding.
            if share == S::one()
                && !(lower && size <= last.size * S::constant(SLOW))
                && let Some(solution) =
                    stagnated(&finish, state, last, lower.then_some(&trial), [iterations, damped])
            {
                return Ok(solution);
            }
            if !lower {
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
            contraction = size / last.size;
        }

        let correction = kernel
            .matrix
            .solve(&residual)
            .map_err(|singular| unsolvable(singular, &residual, &kernel.matrix, iterations, damped))?;
        let v = trial;
        trial = v - correction;
        let floor = estimated_floor(p, &kernel.matrix, &trial);
        let size = in_units_of(&residual, &floor);
        if !size.is_finite()
            && let Some(index) = first_non_finite(&residual, &kernel.matrix)
        {
            return Err(StepError::NonFinite { quantity: Quantity::Derivatives, index });
        }
        if iterations == MAX_ITERATIONS {
            let (residual, floor) = worst(&residual, &floor);
            return Err(StepError::NotConverged {
                iterations,
                residual: residual.widen(),
                floor: floor.widen(),
            });
        }
        iterations += 1;

        // Newton's residuals fall as |r′| ≈ C|r|², so the last contraction c predicts the next one, c². Where that ends at
        // the floor, the matrix is not needed again.
        if kind == Equation::Linear || size <= S::one() || contraction * contraction * size <= S::one() {
            let momenta = finish(q, &trial);
            let remaining = momenta.p0 - p;
            if in_units_of(&remaining, &floor) <= S::constant(AT_FLOOR) {
                let (residual, floor) = worst(&remaining, &floor);
                let last_correction = correction.amax();
                let report = Report { iterations, damped, residual, floor, last_correction };
                return Ok(Solution { unknown: trial, momenta, report });
            }
        }
        share = S::one();
        iterate = Some(Iterate { v, residual, correction, floor, size });
    }
}

/// The root at an iterate whose residual has stopped falling, if rounding holds the residual up there. `lower` is where the
/// Newton step led, if that still lowered it.
#[cold]
fn stagnated<S: Scalar, const N: usize>(
    finish: &Finish<'_, S, N>,
    state: &State<S, N>,
    last: &Iterate<S, N>,
    lower: Option<&SVector<S, N>>,
    [iterations, damped]: [u32; 2],
) -> Option<Solution<S, N>> {
    let unknown = *lower.unwrap_or(&last.v);
    let momenta = finish(&state.q, &unknown);
    let residual = momenta.p0 - state.p;
    let measured = last.floor + rounding(|q, v| finish(q, v).p0, &state.q, &unknown);
    let explained = in_units_of(&residual, &measured) <= S::constant(AT_FLOOR);
    let close = last.size <= S::constant(STAGNATION);
    if !explained && (lower.is_some() || !close) {
        return None;
    }
    let (residual, floor) = worst(&residual, if explained { &measured } else { &last.floor });
    let report = Report { iterations, damped, residual, floor, last_correction: last.correction.amax() };
    Some(Solution { unknown, momenta, report })
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

/// Tells a residual that rounding holds up from one that has no root.
#[cold]
fn give_up<S: Scalar, const N: usize>(iteration: u32, last: &Iterate<S, N>) -> StepError {
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
