//! A fixed number of Newton iterations, for a clock that does not wait.

use nalgebra::SVector;

use super::rounding::{estimated_floor, held_against};
use super::{Solution, is_known_at, is_small_beside, largest};
use crate::numbers::{NewtonMatrix, Scalar, Singular, nonlinear::in_units_of};
use crate::step::cause::explained;
use crate::step::equation::StepEquation;
use crate::step::{Report, Segment, State, StepError};
use crate::system::Quantity;

/// The best iterate of at most `bound` undamped Newton iterations, and whether it is the solution, by the
/// definition of `rounding.rs`.
///
/// The work is bounded: `bound` evaluations of the kernel, as many solves, and `bound` + 1 evaluations of the
/// momenta.
pub(crate) fn bounded<S: Scalar, const N: usize>(
    equation: &impl StepEquation<S, N>,
    bound: u32,
    State { q, p }: &State<S, N>,
    h: S,
    guess: SVector<S, N>,
) -> Result<(Solution<S, N>, bool), StepError> {
    let at = |v: &SVector<S, N>| Segment { q0: *q, v: *v, h };
    let mut v = guess;
    let mut best: Option<(S, Solution<S, N>, bool)> = None;
    for iteration in 0..bound.max(1) {
        let kernel = equation.kernel(&at(&v));
        let residual = kernel.p0 - p;
        let known = equation.correction(&residual);
        let correction = match known.map_or_else(|| kernel.matrix.solve(&residual), Ok) {
            Ok(correction) => correction,
            // What was reached before stands.
            Err(_) if best.is_some() => break,
            Err(Singular { column }) => {
                let error = match first_non_finite(&residual, &kernel.matrix) {
                    Some(index) => StepError::NonFinite { quantity: Quantity::Derivatives, index },
                    None => StepError::SingularNewtonMatrix { iteration, column },
                };
                return Err(explained(error, &|| equation.cause(&at(&v))));
            }
        };
        let next = v - correction;
        let momenta = equation.momenta(&at(&next));
        let remaining = momenta.p0 - p;
        let floor = estimated_floor(p, &kernel.matrix, &next);
        let size = in_units_of(remaining.as_slice(), floor.as_slice());
        // A guess or a step that leaves the domain of L, R or f.
        if !size.is_finite() && best.is_none() {
            let index = first_non_finite(&residual, &kernel.matrix)
                .or_else(|| (0..N).find(|&i| !remaining[i].is_finite()))
                .unwrap_or(0);
            let error = StepError::NonFinite { quantity: Quantity::Derivatives, index };
            return Err(explained(error, &|| equation.cause(&at(&v)).or_else(|| equation.cause(&at(&next)))));
        }
        let (residual, floor, is_root) = held_against(&remaining, &floor);
        let last_correction = largest(correction.as_slice());
        let is_solved =
            is_root && (is_small_beside(&remaining, p) || is_known_at(equation.kind(), &next, &correction));
        if is_solved || best.as_ref().is_none_or(|(least, ..)| size < *least) {
            let report = Report { iterations: iteration + 1, damped: 0, residual, floor, last_correction };
            best = Some((size, Solution { unknown: next, momenta, report }, is_solved));
        }
        if is_solved {
            break;
        }
        v = next;
    }
    match best {
        Some((_, solution, is_solved)) => Ok((solution, is_solved)),
        None => Err(StepError::NonFinite { quantity: Quantity::Derivatives, index: 0 }),
    }
}

#[cold]
fn first_non_finite<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    residual: &SVector<S, N>,
    matrix: &M,
) -> Option<usize> {
    (0..N).find(|&i| !residual[i].is_finite() || !matrix.row_is_finite(i))
}
