//! Newton's method with the analytic matrix, damped where a full step does not lower the residual.
//!
//! Residuals are measured in units of their round-off floor, component by component,
//!
//! ```text
//! floorᵢ = 4ε (|targetᵢ| + Σⱼ |Jᵢⱼ||vⱼ|)        v: the iterate that the Newton step leads to
//! ```
//!
//! so that neither the unit of a coordinate nor its neighbours' size matters.

use nalgebra::{SMatrix, SVector};

use crate::error::{Quantity, StepError};
use crate::linear::Factors;
use crate::{Report, Scalar};

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

/// Newton's method needs a few iterations where it converges at all; damped ones near a fold take some more.
const MAX_ITERATIONS: u32 = 50;

/// Halvings of a Newton step before its direction is given up.
const MAX_HALVINGS: u32 = 12;

/// A residual of at most this many floors is as good as rounding allows once it has stopped falling.
const STAGNATION: f64 = 4096.0;

/// Solves value(v) = target.
///
/// `evaluate` gives value and matrix; `finish` the value alone, with the by-product wanted at the root. The residual that
/// the report states is the one that `finish` measured there.
#[inline]
pub(crate) fn solve<S: Scalar, T, const N: usize>(
    evaluate: impl Fn(&SVector<S, N>) -> Evaluation<S, N>,
    finish: impl Fn(&SVector<S, N>) -> (SVector<S, N>, T),
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
            let (value, by_product) = finish(&candidate);
            let remaining = value - target;
            if in_units_of(&remaining, &floor) <= S::constant(4.0) {
                let report = Report {
                    iterations: iteration + 1,
                    damped,
                    residual: remaining.amax(),
                    floor: floor.amax(),
                    last_correction: correction.amax(),
                };
                return Ok(Solution { unknown: candidate, by_product, report });
            }
        }

        let mut share = S::one();
        let mut halvings = 0;
        loop {
            let candidate = v - correction * share;
            let next = evaluate(&candidate);
            let next_residual = next.value - target;
            let next_size = in_units_of(&next_residual, &floor);
            if next_size < size {
                contraction = next_size / size;
                last_correction = (correction * share).amax();
                (v, at_v, residual) = (candidate, next, next_residual);
                break;
            }
            if size <= S::constant(STAGNATION) {
                return stagnated(finish, target, v, &floor, iteration, damped, last_correction);
            }
            halvings += 1;
            if halvings > MAX_HALVINGS {
                return Err(give_up(iteration, &residual, &floor, &correction, &v));
            }
            share *= S::constant(0.5);
        }
        damped += u32::from(halvings > 0);
    }

    Err(StepError::NotConverged {
        iterations: MAX_ITERATIONS,
        residual: residual.amax().widen(),
        floor: floor(target, &at_v.matrix, &v).amax().widen(),
    })
}

/// Accepts an iterate whose residual is at rounding level, though above the estimated floor.
#[cold]
fn stagnated<S: Scalar, T, const N: usize>(
    finish: impl Fn(&SVector<S, N>) -> (SVector<S, N>, T),
    target: &SVector<S, N>,
    v: SVector<S, N>,
    floor: &SVector<S, N>,
    iterations: u32,
    damped: u32,
    last_correction: S,
) -> Result<Solution<S, T, N>, StepError> {
    let (value, by_product) = finish(&v);
    let residual = (value - target).amax();
    let report = Report { iterations, damped, residual, floor: floor.amax(), last_correction };
    Ok(Solution { unknown: v, by_product, report })
}

/// Tells a residual that rounding holds up from one that has no root.
#[cold]
fn give_up<S: Scalar, const N: usize>(
    iteration: u32,
    residual: &SVector<S, N>,
    floor: &SVector<S, N>,
    correction: &SVector<S, N>,
    v: &SVector<S, N>,
) -> StepError {
    let residual = residual.amax().widen();
    if correction.amax() <= S::EPSILON.sqrt() * v.amax() {
        StepError::LostPrecision { residual, floor: floor.amax().widen() }
    } else {
        StepError::NoRealSolution { iteration, residual }
    }
}

#[inline]
fn floor<S: Scalar, const N: usize>(
    target: &SVector<S, N>,
    matrix: &SMatrix<S, N, N>,
    v: &SVector<S, N>,
) -> SVector<S, N> {
    SVector::from_fn(|i, _| {
        let mut sum = target[i].abs();
        for j in 0..N {
            sum += (matrix[(i, j)] * v[j]).abs();
        }
        sum * (S::EPSILON * S::constant(4.0))
    })
}

/// max |residualᵢ|/floorᵢ. An exact 0 counts 0, even over a floor of 0; a NaN or infinite ratio is returned as it is.
#[inline]
fn in_units_of<S: Scalar, const N: usize>(residual: &SVector<S, N>, floor: &SVector<S, N>) -> S {
    let mut largest = S::zero();
    for i in 0..N {
        if residual[i] != S::zero() {
            let units = residual[i].abs() / floor[i];
            if !units.is_finite() {
                return units;
            }
            largest = largest.max(units);
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
