//! The damped method, and what its failures mean.

use core::mem::swap;

use super::equations::{Equations, Matrix, Root, Solved, Unsolved};
use super::rounding::{SLOW, estimated_floor, in_units_of, worst};
use super::vectors::{Room, copy, largest, sum};
use super::verdict::{Counts, Rounding, stagnated, verified};
use crate::numbers::Precision;

/// Newton's method needs a few iterations near a root; damped ones near a fold, or undamped ones from far out
/// on a power law, where each takes off a fixed share, need some dozens.
pub(super) const MAX_ITERATIONS: u32 = 100;

/// Once the step has been shortened below this share, a singular matrix is reported instead of stepped
/// around.
const SHORTEST: f64 = 1e-3;

/// An iterate, the Newton step from it, and the measure of its residual. The matrix there is the one before.
struct Iterate<'r, S> {
    v: &'r mut [S],
    residual: &'r mut [S],
    /// The full Newton step leads to v − correction.
    correction: &'r mut [S],
    floor: &'r mut [S],
    /// max |residualᵢ|/floorᵢ; nothing before the first iterate.
    size: Option<S>,
}

/// The damped method, and the verdicts, from the velocity of `root`, to which `iterations` have led.
///
/// # Errors
/// [`Unsolved`]: [`NoRoot`](Unsolved::NoRoot) as well where something does not hold that the equation does
/// not see.
pub(super) fn careful<S: Precision>(
    of: &mut Equations<'_, S>,
    iterations: u32,
    root: &mut Root<'_, S>,
    room: Room<'_, S>,
) -> Result<Solved<S>, Unsolved<S>> {
    let found = damped(of, iterations, root, room)?;
    if of.evaluate.is_held(of.q, root.v, of.h) {
        Ok(found)
    } else {
        Err(Unsolved::NoRoot { iteration: found.iterations, residual: found.residual })
    }
}

#[inline(never)]
fn damped<S: Precision>(
    of: &mut Equations<'_, S>,
    mut iterations: u32,
    root: &mut Root<'_, S>,
    mut room: Room<'_, S>,
) -> Result<Solved<S>, Unsolved<S>> {
    let [mut trial, mut residual, mut correction] = room.vectors();
    let [v, last_residual, last_correction, floor] = room.vectors();
    let mut last = Iterate { v, residual: last_residual, correction: last_correction, floor, size: None };
    copy(trial, root.v);
    let mut share = S::one();
    let mut contraction = S::one();
    let mut damped = 0;

    loop {
        of.evaluate(trial, residual);
        if let Some(before) = last.size {
            let size = in_units_of(residual, last.floor);
            let lower = size < before;
            // A contraction that is none, or that is no longer Newton's, may be rounding, unless the next
            // step is a shorter one.
            let slow = share == S::one() && !(lower && size <= before * S::nearest(SLOW));
            let nearer = slow && nearer(of, residual, &last, room.inner());
            if slow && !nearer {
                let counts = Counts { iterations, damped, last_correction: largest(last.correction) };
                let found = stagnated(of, last.v, (trial, lower), counts, root, room.inner());
                if let Some(solution) = found {
                    return Ok(solution);
                }
            }
            if !lower && !nearer {
                share = shorter(share, before, size);
                if is_below(S::SPACING.sqrt(), share, &last) || share < S::SPACING * S::SPACING {
                    return Err(match of.first_non_finite(residual) {
                        Some(index) => Unsolved::NonFinite { index },
                        None => give_up(iterations, &last),
                    });
                }
                last.lead(share, trial);
                continue;
            }
            damped += u32::from(share < S::one());
            // Unknown where the residual says nothing.
            contraction = if lower { size / before } else { S::one() };
        }

        if let Err(singular) = of.evaluate.solve(residual, correction) {
            let non_finite = of.first_non_finite(residual);
            // The matrix is singular along the way only; a shorter step leads elsewhere.
            if last.size.is_some() && share > S::nearest(SHORTEST) && non_finite.is_none() {
                // It was no iterate: nothing is corrected from it.
                damped -= u32::from(share < S::one());
                share *= S::nearest(0.5);
                last.lead(share, trial);
                continue;
            }
            return Err(match non_finite {
                Some(index) => Unsolved::NonFinite { index },
                // Damped descent ends at a singular matrix where the residual has its least value, above 0.
                None if damped > 0 => Unsolved::NoRoot { iteration: iterations, residual: largest(residual) },
                None => Unsolved::Singular { iteration: iterations, column: singular.column },
            });
        }
        // At rest between forces that cancel the undamped method has ended at the root's rounding already:
        // one more correction, so that what is left is rounding alone.
        if last.size.is_none() {
            let counts = Counts { iterations: iterations + 1, damped, last_correction: largest(correction) };
            sum(last.v, trial, -S::one(), correction);
            let found = verified(of, (last.v, Matrix::Present), counts, Rounding::Terms, root, room.inner());
            if let Some(solution) = found {
                return Ok(solution);
            }
        }
        of.evaluate.keep();
        swap(&mut last.v, &mut trial);
        swap(&mut last.residual, &mut residual);
        swap(&mut last.correction, &mut correction);
        sum(trial, last.v, -S::one(), last.correction);
        estimated_floor(of, Matrix::Before, trial, last.floor, room.inner());
        let size = in_units_of(last.residual, last.floor);
        if !size.is_finite()
            && let Some(index) = of.first_non_finite(last.residual)
        {
            return Err(Unsolved::NonFinite { index });
        }
        if iterations >= MAX_ITERATIONS {
            let (residual, floor) = worst(last.residual, last.floor);
            return Err(Unsolved::NotConverged { iterations, residual, floor });
        }
        iterations += 1;

        if size <= S::one() || contraction * contraction * size <= S::one() {
            // The matrix at the root itself: that of an iterate far out can be larger by many orders of
            // magnitude.
            of.evaluate(trial, residual);
            let counts = Counts { iterations, damped, last_correction: largest(last.correction) };
            if let Some(solution) =
                verified(of, (trial, Matrix::Present), counts, Rounding::Floor, root, room.inner())
            {
                return Ok(solution);
            }
        }
        share = S::one();
        last.size = Some(size);
    }
}

impl<S: Precision> Iterate<'_, S> {
    /// Goes this share of the Newton step.
    fn lead(&self, share: S, trial: &mut [S]) {
        sum(trial, self.v, -share, self.correction);
    }
}

/// Whether a full step whose residual is no lower is nearer to the root all the same: the Newton step from
/// there is at most half as long, with Σ |Mᵢᵢ| vᵢ² for the square of a length, by a matrix that has not
/// grown.
///
/// Neither the units of a coordinate nor a stiff direction that turns, nor a component that was 0, change
/// this verdict. With one coordinate it is that of the residual.
#[inline(never)]
fn nearer<S: Precision>(
    of: &Equations<'_, S>,
    residual: &[S],
    last: &Iterate<'_, S>,
    mut room: Room<'_, S>,
) -> bool {
    let [next, now, before, inertia] = room.vectors();
    if of.evaluate.solve(residual, next).is_err() {
        return false;
    }
    of.evaluate.diagonal(Matrix::Present, now);
    of.evaluate.diagonal(Matrix::Before, before);
    if now.iter().zip(before.iter()).any(|(now, before)| *now > *before * S::nearest(2.0)) {
        return false;
    }
    of.evaluate.diagonal(Matrix::Mass { q: of.q, v: last.v }, inertia);
    let square =
        |v: &[S]| v.iter().zip(inertia.iter()).fold(S::zero(), |sum, (v, mass)| sum + *v * *v * *mass);
    square(next) < square(last.correction) * S::nearest(0.25)
}

/// A share of the Newton step to try after `share` gave `next_size` ≥ `size`: where (1 − s) + C s², the
/// residual's first two terms along the step, is least; between a tenth and a half of the present share.
#[cold]
pub(crate) fn shorter<S: Precision>(share: S, size: S, next_size: S) -> S {
    let curvature = (next_size / size - S::one() + share) / (share * share);
    let least = S::nearest(0.5) / curvature;
    let (tenth, half) = (share * S::nearest(0.1), share * S::nearest(0.5));
    // Not finite where the step left the domain of L, R or f: `least` is 0 or NaN, and fails the comparison.
    if least > tenth { if least < half { least } else { half } } else { tenth }
}

/// Whether this share of the Newton step makes no difference beyond `factor` in v.
fn is_below<S: Precision>(factor: S, share: S, last: &Iterate<'_, S>) -> bool {
    let mut pairs = last.correction.iter().zip(last.v.iter());
    pairs.all(|(correction, v)| (*correction * share).abs() <= factor * v.abs())
}

/// Tells a residual that rounding holds up from one that has no root.
fn give_up<S: Precision>(iteration: u32, last: &Iterate<'_, S>) -> Unsolved<S> {
    // Near a fold the matrix is almost singular and the correction large; lost digits leave it small.
    if is_below(S::SPACING.cbrt(), S::one(), last) {
        let (residual, floor) = worst(last.residual, last.floor);
        Unsolved::LostPrecision { residual, floor }
    } else {
        Unsolved::NoRoot { iteration, residual: largest(last.residual) }
    }
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
