//! A fixed number of Newton iterations, for a clock that does not wait.

use nalgebra::SVector;

use super::rounding::{AT_FLOOR, estimated_floor, in_units_of, worst};
use super::{Solution, first_non_finite, unsolvable};
use crate::discrete::{Momenta, StepKernel};
use crate::linear::NewtonMatrix;
use crate::{Quantity, Report, Scalar, State, StepError};

/// The best iterate of at most `bound` undamped Newton iterations, and whether its residual is at its floor.
///
/// The work is bounded: `bound` evaluations of the kernel, as many solves, and `bound` + 1 evaluations of the momenta.
pub(crate) fn bounded<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    bound: u32,
    evaluate: impl Fn(&SVector<S, N>, &SVector<S, N>) -> StepKernel<S, N, M>,
    finish: impl Fn(&SVector<S, N>, &SVector<S, N>) -> Momenta<S, N>,
    State { q, p }: &State<S, N>,
    guess: SVector<S, N>,
) -> Result<(Solution<S, N>, bool), StepError> {
    let mut v = guess;
    let mut best: Option<(S, Solution<S, N>)> = None;
    for iteration in 0..bound.max(1) {
        let kernel = evaluate(q, &v);
        let residual = kernel.p0 - p;
        let correction = match kernel.matrix.solve(&residual) {
            Ok(correction) => correction,
            // What was reached before stands.
            Err(_) if best.is_some() => break,
            Err(singular) => return Err(unsolvable(singular, &residual, &kernel.matrix, iteration, 0)),
        };
        let next = v - correction;
        let momenta = finish(q, &next);
        let remaining = momenta.p0 - p;
        let floor = estimated_floor(p, &kernel.matrix, &next);
        let size = in_units_of(&remaining, &floor);
        // A guess or a step that leaves the domain of L, R or f.
        if !size.is_finite() && best.is_none() {
            let index = first_non_finite(&residual, &kernel.matrix)
                .or_else(|| (0..N).find(|&i| !remaining[i].is_finite()))
                .unwrap_or(0);
            return Err(StepError::NonFinite { quantity: Quantity::Derivatives, index });
        }
        if best.as_ref().is_none_or(|(least, _)| size < *least) {
            let (residual, floor) = worst(&remaining, &floor);
            let last_correction = correction.amax();
            let report = Report { iterations: iteration + 1, damped: 0, residual, floor, last_correction };
            best = Some((size, Solution { unknown: next, momenta, report }));
        }
        if size <= S::constant(AT_FLOOR) {
            break;
        }
        v = next;
    }
    match best {
        Some((size, solution)) => Ok((solution, size <= S::constant(AT_FLOOR))),
        None => Err(StepError::NonFinite { quantity: Quantity::Derivatives, index: 0 }),
    }
}
