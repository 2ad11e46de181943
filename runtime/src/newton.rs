//! Newton's method with the analytic matrix, damped where a full step does not lower the residual.
//!
//! Residuals are measured in units of their round-off floor, component by component,
//!
//! ```text
//! floorᵢ = 4ε (|targetᵢ| + Σⱼ |Jᵢⱼ||vⱼ|)        v: the iterate that the Newton step leads to
//! ```
//!
//! so that neither the unit of a coordinate nor its neighbours' size matters. Forces that cancel, as at an equilibrium, are
//! noisier than that: where the residual stops falling above its floor, it is held against the change that one rounding of
//! q makes, measured then and there.

use nalgebra::{SMatrix, SVector};

use crate::discrete::StepKernel;
use crate::error::{Quantity, StepError};
use crate::linear;
use crate::{Report, Scalar, State};

/// A root.
pub(crate) struct Solution<S, E, const N: usize> {
    pub(crate) unknown: SVector<S, N>,
    pub(crate) report: Report<S>,
    /// What else the last evaluation gave,
    pub(crate) last: E,
    /// and how far from there the root is: unknown = point of the last evaluation − correction.
    pub(crate) correction: SVector<S, N>,
}

/// Newton's method needs a few iterations where it converges at all; damped ones near a fold take some more.
const MAX_ITERATIONS: u32 = 50;

/// Halvings of a Newton step before its direction is given up.
const MAX_HALVINGS: u32 = 12;

/// Rounding errors of an evaluation, in units of the change that one rounding of q makes.
const ROUNDINGS: f64 = 32.0;

/// Solves p0(q, v) = p for v at the `state` (q, p). What the evaluation gives beside the kernel is handed through.
#[inline]
pub(crate) fn solve<S: Scalar, E: Copy, const N: usize>(
    evaluate: impl Fn(&SVector<S, N>, &SVector<S, N>) -> (StepKernel<S, N>, E),
    state: &State<S, N>,
    guess: SVector<S, N>,
) -> Result<Solution<S, E, N>, StepError> {
    let State { q, p: target } = state;
    let mut v = guess;
    let (mut at_v, mut last) = evaluate(q, &v);
    let mut residual = at_v.p0 - target;
    let mut contraction = S::one();
    let mut damped = 0;

    for iteration in 0..MAX_ITERATIONS {
        let correction =
            linear::solve(&at_v.matrix, &residual).map_err(|singular| {
                match first_non_finite(&residual, &at_v.matrix) {
                    Some(index) => StepError::NonFinite { quantity: Quantity::Derivatives, index },
                    None => StepError::SingularNewtonMatrix { iteration, column: singular.column },
                }
            })?;
        let full = v - correction;
        let units = reciprocal_floor(target, &at_v.matrix, &full);
        let size = in_units(&residual, &units);
        if !size.is_finite()
            && let Some(index) = first_non_finite(&residual, &at_v.matrix)
        {
            return Err(StepError::NonFinite { quantity: Quantity::Derivatives, index });
        }

        // Newton's residuals fall as |r′| ≈ C|r|², so the last contraction c predicts the next one, c². Where that ends at
        // the floor, the Newton matrix is not needed again.
        let square = contraction * contraction;
        if size <= S::one() || square * size <= S::one() {
            let report = Report {
                iterations: iteration + 1,
                damped,
                residual: residual.amax() * square,
                floor: largest_floor(&units),
                last_correction: correction.amax(),
            };
            return Ok(Solution { unknown: full, report, last, correction });
        }

        let mut candidate = full;
        let mut share = S::one();
        let mut halvings = 0;
        loop {
            let (next, next_last) = evaluate(q, &candidate);
            let next_residual = next.p0 - target;
            let next_size = in_units(&next_residual, &units);
            if next_size < size {
                contraction = next_size / size;
                (v, at_v, residual, last) = (candidate, next, next_residual, next_last);
                break;
            }
            if halvings == 0 {
                let noise = noise(&evaluate, q, &v, &at_v);
                if (0..N).all(|i| residual[i].abs() <= noise[i] + S::one() / units[i]) {
                    let report = Report {
                        iterations: iteration + 1,
                        damped,
                        residual: residual.amax(),
                        floor: noise.amax(),
                        last_correction: correction.amax(),
                    };
                    return Ok(Solution { unknown: v, report, last, correction: SVector::zeros() });
                }
            }
            halvings += 1;
            if halvings > MAX_HALVINGS {
                return Err(give_up(iteration, &residual, &units, &correction, &v));
            }
            share *= S::constant(0.5);
            candidate = v - correction * share;
        }
        if halvings > 0 {
            damped += 1;
            // A damped step says nothing of Newton's own convergence.
            contraction = S::one();
        }
    }

    Err(StepError::NotConverged {
        iterations: MAX_ITERATIONS,
        residual: residual.amax().widen(),
        floor: largest_floor(&reciprocal_floor(target, &at_v.matrix, &v)).widen(),
    })
}

/// What rounding leaves of the residual: the change of p0 as each coordinate of q moves by a rounding error.
#[cold]
fn noise<S: Scalar, E, const N: usize>(
    evaluate: impl Fn(&SVector<S, N>, &SVector<S, N>) -> (StepKernel<S, N>, E),
    q: &SVector<S, N>,
    v: &SVector<S, N>,
    at_v: &StepKernel<S, N>,
) -> SVector<S, N> {
    let mut noise = SVector::zeros();
    for j in 0..N {
        let mut moved = *q;
        moved[j] *= S::one() + S::EPSILON * S::constant(ROUNDINGS);
        noise += (evaluate(&moved, v).0.p0 - at_v.p0).abs();
    }
    noise
}

/// Tells a residual that rounding holds up from one that has no root.
#[cold]
fn give_up<S: Scalar, const N: usize>(
    iteration: u32,
    residual: &SVector<S, N>,
    units: &SVector<S, N>,
    correction: &SVector<S, N>,
    v: &SVector<S, N>,
) -> StepError {
    let residual = residual.amax().widen();
    if correction.amax() <= S::EPSILON.sqrt() * v.amax() {
        StepError::LostPrecision { residual, floor: largest_floor(units).widen() }
    } else {
        StepError::NoRealSolution { iteration, residual }
    }
}

/// 1/floorᵢ; infinite where the floor is 0.
#[inline]
fn reciprocal_floor<S: Scalar, const N: usize>(
    target: &SVector<S, N>,
    matrix: &SMatrix<S, N, N>,
    v: &SVector<S, N>,
) -> SVector<S, N> {
    SVector::from_fn(|i, _| {
        let mut sum = target[i].abs();
        for j in 0..N {
            sum += (matrix[(i, j)] * v[j]).abs();
        }
        S::one() / (sum * (S::EPSILON * S::constant(4.0)))
    })
}

/// The largest floor.
#[inline]
fn largest_floor<S: Scalar, const N: usize>(units: &SVector<S, N>) -> S {
    let smallest =
        units.iter().fold(units[0], |smallest, unit| if *unit < smallest { *unit } else { smallest });
    S::one() / smallest
}

/// max |residualᵢ|/floorᵢ. An exact 0 counts 0, even over a floor of 0; a NaN or infinite ratio is returned as it is.
#[inline]
fn in_units<S: Scalar, const N: usize>(residual: &SVector<S, N>, units: &SVector<S, N>) -> S {
    let mut largest = S::zero();
    for i in 0..N {
        if residual[i] != S::zero() {
            let size = residual[i].abs() * units[i];
            if !size.is_finite() {
                return size;
            }
            if size > largest {
                largest = size;
            }
        }
    }
    largest
}

#[cold]
fn first_non_finite<S: Scalar, const N: usize>(
    residual: &SVector<S, N>,
    matrix: &SMatrix<S, N, N>,
) -> Option<usize> {
    (0..N).find(|&i| !residual[i].is_finite() || matrix.row(i).iter().any(|entry| !entry.is_finite()))
}
