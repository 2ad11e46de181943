//! Newton's method with the analytic matrix, damped where a full step does not lower the residual.
//!
//! Residuals are measured in units of their round-off floor, component by component,
//!
//! ```text
//! floorᵢ = 4ε (|pᵢ| + Σⱼ |Jᵢⱼ||vⱼ|)        v: the iterate that the Newton step leads to
//! ```
//!
//! so that neither the unit of a coordinate nor its neighbours' size matters. This estimate knows nothing of what q
//! contributes: near an equilibrium away from q = 0 large forces cancel, and v and p go to 0 while the rounding of those
//! forces stays. Where the residual stops falling above the estimate, its rounding is therefore measured ([`rounding`]).

use nalgebra::{SMatrix, SVector};

use crate::discrete::{Momenta, StepKernel};
use crate::error::{Quantity, StepError};
use crate::linear::{self, Singular};
use crate::{Report, Scalar, State};

/// A root, with both momenta there.
pub(crate) struct Solution<S, const N: usize> {
    pub(crate) unknown: SVector<S, N>,
    pub(crate) momenta: Momenta<S, N>,
    pub(crate) report: Report<S>,
}

/// Newton's method needs a few iterations where it converges at all; damped ones near a fold take some more.
const MAX_ITERATIONS: u32 = 50;

/// A residual of at most this many estimated floors is as good as rounding allows once it has stopped falling.
const STAGNATION: f64 = 4096.0;

/// The same in units of the measured floor, and for the residual at a root that was predicted.
const AT_FLOOR: f64 = 4.0;

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

/// Solves p0(q, v) = p for v at the `state` (q, p).
///
/// `evaluate` gives p0 and the Newton matrix, `finish` both momenta. The residual that the report states is the one that
/// `finish` measured at the root.
#[inline]
pub(crate) fn solve<S: Scalar, const N: usize>(
    evaluate: impl Fn(&SVector<S, N>, &SVector<S, N>) -> StepKernel<S, N>,
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
                && let Some(floor) = rounding_floor(&finish, q, last)
            {
                return Ok(stagnated(&finish, state, last, &floor, [iterations, damped]));
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

        let correction = linear::solve(&kernel.matrix, &residual)
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
        iterations += 1;

        // Newton's residuals fall as |r′| ≈ C|r|², so the last contraction c predicts the next one, c². Where that ends at
        // the floor, the matrix is not needed again.
        if size <= S::one() || contraction * contraction * size <= S::one() {
            let momenta = finish(q, &trial);
            let remaining = momenta.p0 - p;
            if in_units_of(&remaining, &floor) <= S::constant(AT_FLOOR) {
                let (residual, floor) = worst(&remaining, &floor);
                let last_correction = correction.amax();
                let report = Report { iterations, damped, residual, floor, last_correction };
                return Ok(Solution { unknown: trial, momenta, report });
            }
        }
        if iterations == MAX_ITERATIONS {
            let (residual, floor) = worst(&residual, &floor);
            return Err(StepError::NotConverged {
                iterations,
                residual: residual.widen(),
                floor: floor.widen(),
            });
        }
        share = S::one();
        iterate = Some(Iterate { v, residual, correction, floor, size });
    }
}

/// The floor of an iterate whose residual has stopped falling, if the residual is at it.
#[cold]
fn rounding_floor<S: Scalar, const N: usize>(
    finish: &Finish<'_, S, N>,
    q: &SVector<S, N>,
    last: &Iterate<S, N>,
) -> Option<SVector<S, N>> {
    if last.size <= S::constant(STAGNATION) {
        return Some(last.floor);
    }
    let floor = last.floor + rounding(finish, q, &last.v);
    (in_units_of(&last.residual, &floor) <= S::constant(AT_FLOOR)).then_some(floor)
}

/// Accepts an iterate whose residual is at rounding level, though above the estimated floor.
#[cold]
fn stagnated<S: Scalar, const N: usize>(
    finish: &Finish<'_, S, N>,
    state: &State<S, N>,
    last: &Iterate<S, N>,
    floor: &SVector<S, N>,
    [iterations, damped]: [u32; 2],
) -> Solution<S, N> {
    let momenta = finish(&state.q, &last.v);
    let (residual, floor) = worst(&(momenta.p0 - state.p), floor);
    let report = Report { iterations, damped, residual, floor, last_correction: last.correction.amax() };
    Solution { unknown: last.v, momenta, report }
}

/// What rounding does to p0: its changes when each entry of q and of v moves by its last place, added up.
fn rounding<S: Scalar, const N: usize>(
    finish: &Finish<'_, S, N>,
    q: &SVector<S, N>,
    v: &SVector<S, N>,
) -> SVector<S, N> {
    let p0 = finish(q, v).p0;
    let mut sum: SVector<S, N> = nalgebra::zero();
    let mut add = |q: &SVector<S, N>, v: &SVector<S, N>| sum += (finish(q, v).p0 - p0).abs();
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

/// What a Newton matrix that cannot be solved with means.
#[cold]
fn unsolvable<S: Scalar, const N: usize>(
    singular: Singular,
    residual: &SVector<S, N>,
    matrix: &SMatrix<S, N, N>,
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

/// The floor that the terms of p0 give.
#[inline]
fn estimated_floor<S: Scalar, const N: usize>(
    target: &SVector<S, N>,
    matrix: &SMatrix<S, N, N>,
    v: &SVector<S, N>,
) -> SVector<S, N> {
    SVector::from_fn(|i, _| {
        let mut sum = target[i].abs();
        for j in 0..N {
            sum += (matrix[(i, j)] * v[j]).abs();
        }
        // Below the normal numbers ε no longer bounds the rounding.
        sum * (S::EPSILON * S::constant(4.0)) + S::SMALLEST_NORMAL
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
