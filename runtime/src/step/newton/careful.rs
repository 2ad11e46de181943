//! The damped method, and what its failures mean.

use nalgebra::SVector;

use super::rounding::{SLOW, estimated_floor, in_units_of, worst};
use super::verdict::{Iterate, stagnated, verified};
use super::{Equations, Reached, Solution, largest};
use crate::numbers::{NewtonMatrix, Scalar, Singular};
use crate::step::{Quantity, State, StepError, StepKernel};

/// Newton's method needs a few iterations near a root; damped ones near a fold, or undamped ones from far out
/// on a power law, where each takes off a fixed share, need some dozens.
pub(super) const MAX_ITERATIONS: u32 = 100;

/// Once the step has been shortened below this share, a singular matrix is reported instead of stepped
/// around.
const SHORTEST: f64 = 1e-3;

/// The damped method, and the verdicts.
#[cold]
#[inline(never)]
pub(super) fn careful<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
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
            // A contraction that is none, or that is no longer Newton's, may be rounding, unless the next
            // step is a shorter one.
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
            // The matrix at the root itself: that of an iterate far out can be larger by many orders of
            // magnitude.
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

/// Whether a full step whose residual is no lower is nearer to the root all the same: the Newton step from
/// there is at most half as long, with Σ |Mᵢᵢ| vᵢ² for the square of a length, by a matrix that has not
/// grown.
///
/// Neither the units of a coordinate nor a stiff direction that turns, nor a component that was 0, change
/// this verdict. With one coordinate it is that of the residual.
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

/// The error of a Newton matrix that cannot be solved with.
#[cold]
pub(super) fn unsolvable<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
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

/// A share of the Newton step to try after `share` gave `next_size` ≥ `size`: where (1 − s) + C s², the
/// residual's first two terms along the step, is least; between a tenth and a half of the present share.
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
pub(super) fn first_non_finite<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
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
