//! Newton's method with the analytic matrix, damped where a full step does not lower the residual.
//!
//! Residuals are measured in units of their round-off floor, component by component,
//!
//! ```text
//! floorᵢ = 4ε (|targetᵢ| + Σⱼ |Jᵢⱼ||vⱼ|)        v: the iterate that the Newton step leads to
//! ```
//!
//! so that neither the unit of a coordinate nor its neighbours' size matters. This estimate knows nothing of what q
//! contributes: near an equilibrium away from q = 0 large forces cancel, and v and p go to 0 while the rounding of those
//! forces stays. Where the residual stops falling above the estimate, its rounding is therefore measured ([`rounding`]).

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

/// Newton's method needs a few iterations near a root; damped ones near a fold, or undamped ones from far out on a power
/// law, where each takes off a fixed share, need some dozens.
const MAX_ITERATIONS: u32 = 100;

/// A residual of at most this many estimated floors is as good as rounding allows once it has stopped falling.
const STAGNATION: f64 = 4096.0;

/// A residual of at most this many floors, estimated or measured, is a root.
const ACCEPTED: f64 = 4.0;

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
            if share == S::one() && !(next_size < size * S::constant(SLOW)) {
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

/// The floor that the residual at `v` has reached, if rounding is what holds it up; `size` is its size in units of the
/// estimated `floor`, and `falls` whether a Newton step still lowers it.
#[cold]
fn rounding_floor<S: Scalar, T, const N: usize>(
    finish: impl Fn(&SVector<S, N>, &SVector<S, N>) -> (SVector<S, N>, T),
    q: &SVector<S, N>,
    target: &SVector<S, N>,
    v: &SVector<S, N>,
    floor: &SVector<S, N>,
    size: S,
    falls: bool,
) -> Option<SVector<S, N>> {
    if !falls && size <= S::constant(STAGNATION) {
        return Some(*floor);
    }
    let measured = floor + rounding(&finish, q, v);
    let residual = finish(q, v).0 - target;
    (in_units_of(&residual, &measured) <= S::constant(ACCEPTED)).then_some(measured)
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

/// What rounding does to the value: its changes when each entry of q and of v moves by its last place, added up.
#[cold]
fn rounding<S: Scalar, T, const N: usize>(
    finish: impl Fn(&SVector<S, N>, &SVector<S, N>) -> (SVector<S, N>, T),
    q: &SVector<S, N>,
    v: &SVector<S, N>,
) -> SVector<S, N> {
    let (value, _) = finish(q, v);
    let mut sum: SVector<S, N> = nalgebra::zero();
    let mut add = |q: &SVector<S, N>, v: &SVector<S, N>| sum += (finish(q, v).0 - value).abs();
    for factor in [S::one() + S::EPSILON, S::one() - S::EPSILON] {
        for i in 0..N {
            let mut moved = *q;
            moved[i] *= factor;
            add(&moved, v);
            let mut moved = *v;
            moved[i] *= factor;
            add(q, &moved);
        }
    }
    sum
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

/// The residual that is largest in units of its floor, and this floor.
#[inline]
fn worst<S: Scalar, const N: usize>(residual: &SVector<S, N>, floor: &SVector<S, N>) -> (S, S) {
    let mut worst = (residual[0].abs(), floor[0]);
    for i in 1..N {
        let other = (residual[i].abs(), floor[i]);
        if other.0 * worst.1 > worst.0 * other.1 {
            worst = other;
        }
    }
    worst
}

#[inline]
fn floor<S: Scalar, const N: usize>(
    target: &SVector<S, N>,
    matrix: &SMatrix<S, N, N>,
    v: &SVector<S, N>,
) -> SVector<S, N> {
    // Scaled before they are added up, so that only what overflows itself does.
    let unit = S::EPSILON * S::constant(4.0);
    SVector::from_fn(|i, _| {
        // Below the normal numbers ε no longer bounds the rounding.
        let mut sum = target[i].abs() * unit + S::SMALLEST_NORMAL;
        for j in 0..N {
            sum += (matrix[(i, j)] * (v[j] * unit)).abs();
        }
        sum
    })
}

/// max |residualᵢ|/floorᵢ. An exact 0 counts 0, whatever its floor; a NaN or infinite ratio is returned as it is.
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
