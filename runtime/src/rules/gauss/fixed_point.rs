//! The stages by fixed-point iteration in Nyström order: rates at (Q(V), V), momenta from them, velocities
//! from those.
//!
//! One evaluation of all stages an iteration and no matrix but ∂²L/∂v². Without friction and with a constant
//! mass an iteration takes the error down by O(h²), otherwise by O(h).

use core::cmp::Ordering;

use nalgebra::SVector;

use super::problem::{Problem, Solution, Solver, in_units, in_width, reciprocals};
use super::rounding::{at_rounding, worst};
use crate::numbers::{
    Blank, LaneVector, Scalar,
    lanes::{narrowed, widened},
};
use crate::step::{Report, newton::AT_FLOOR};
use crate::system::{ForcedLagrangian, Stages};

/// More iterations than Newton's method would be worth.
pub(super) const MAX_ITERATIONS: u32 = 60;

/// If two iterations do not halve the residual, Newton's method is cheaper.
pub(super) const SLUGGISH: f64 = 0.5;

/// The residual that the last correction may leave, in floors: with the contraction measured, what is left of
/// it.
pub(super) const AT_REST: f64 = 1.0 / 64.0;

/// After one iteration, only a residual of at most this many floors is taken to shrink in the next as much as
/// it has.
pub(super) const NEAR: f64 = 1024.0;

/// If the floor has risen or fallen by this factor, sizes measured with the old floor are not comparable with
/// new ones. What a contraction promises is far enough below the floor to be below it by this factor more.
pub(super) const CHANGED: f64 = 8.0;

/// A method that corrects the stages' velocities in each sweep.
pub(super) trait Corrector<T, const N: usize> {
    /// The method, as a [`Solution`] names it.
    const SOLVER: Solver;

    /// Whether a correction changes the rates much less than the velocities: then the last one is made
    /// without another evaluation, as far as the contraction measured promises.
    const LEAVES_RATES: bool;

    /// The correction by the stages' residuals.
    fn correction<const W: usize>(&self, stages: &Stages<T, N, W>) -> LaneVector<T, N, W>;
}

/// Each stage by its own mass matrix.
struct ByMass;

impl<T: Scalar, const N: usize> Corrector<T, N> for ByMass {
    const SOLVER: Solver = Solver::FixedPoint;
    const LEAVES_RATES: bool = true;

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn correction<const W: usize>(&self, stages: &Stages<T, N, W>) -> LaneVector<T, N, W> {
        stages.correction
    }
}

/// Solves for the stages from the velocities `guess`, if the iteration contracts.
#[inline]
pub(super) fn iterate<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    guess: &LaneVector<T, N, S>,
) -> Option<Solution<T, N, S>> {
    iterate_by(problem, guess, &ByMass)
}

/// [`iterate`] with any `corrector`, such as the factored matrices of simplified Newton's method.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn iterate_by<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    guess: &LaneVector<T, N, S>,
    corrector: &impl Corrector<T, N>,
) -> Option<Solution<T, N, S>> {
    in_width!(iterate_in::<T, L, _; N, S>(problem, guess, corrector))
}

#[inline(never)]
fn iterate_in<T, L, C, const N: usize, const S: usize, const W: usize>(
    problem: &Problem<'_, L, N, S>,
    guess: &LaneVector<T, N, S>,
    corrector: &C,
) -> Option<Solution<T, N, S>>
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T>,
    C: Corrector<T, N>,
{
    let constant = T::constant;
    let mut v: LaneVector<T, N, W> = widened(*guess);
    let mut anchors = L::Anchors::<W>::blank();
    let (mut floor, mut per_floor) = (SVector::<T, N>::zeros(), SVector::<T, N>::zeros());
    let (mut before, mut last) = (T::one(), T::one());
    let mut iterations = 0;
    // A coordinate begins to move once; floors that rise more often are those of an iteration that runs away.
    let mut rises = 0;
    while iterations < MAX_ITERATIONS {
        let mut stages = problem.next_stages(&mut anchors, &v);
        stages.correction = corrector.correction(&stages);
        if iterations == 0 {
            floor = problem.floor(&stages.rate, &stages.residual);
            per_floor = reciprocals(&floor);
        }
        let mut size = in_units(&stages.residual, &per_floor);
        if iterations == 0 {
            // Nothing is known of the contraction yet.
            last = size;
        } else if size.partial_cmp(&last) != Some(Ordering::Less) {
            // Copies, here and below: what a call is given the address of would be kept in memory through all
            // iterations.
            let (rate, residual) = (stages.rate, stages.residual);
            if let Some(risen) = risen(problem, &rate, &residual, floor) {
                rises += 1;
                if rises > N {
                    return None;
                }
                floor = risen;
                per_floor = reciprocals(&floor);
                size = in_units(&stages.residual, &per_floor);
                // Far from a verdict: the coordinates next to those that have begun to move begin only now.
                (before, last) = (size * constant(4.0), size);
            }
        }
        iterations += 1;
        if !size.is_finite() {
            return None;
        }
        // The contraction is size/last; but where the mass depends on q velocities follow momenta an
        // iteration late, and every other iteration may take off nothing: the one before is heeded
        // too. A first one says little of coordinates with lower floors.
        let mut is_at_rest = C::LEAVES_RATES
            && size * size <= constant(AT_REST) * last
            && if iterations > 2 {
                size * last <= constant(AT_REST) * before
            } else if L::STRUCTURE.constant_mass_matrix {
                N == 1 || size <= constant(NEAR)
            } else {
                size <= constant(AT_REST)
            };
        let has_stopped = iterations > 1 && size >= constant(SLUGGISH) * last;
        let is_low = !C::LEAVES_RATES && size <= T::one();
        let mut is_done = is_at_rest || is_low || (has_stopped && size <= constant(AT_FLOOR));
        if is_done && iterations > 1 {
            // The floor of the guess says nothing of rounding at the root if it was far out, where forces are
            // larger. A residual that is left as it is, is held against the floor where it is left.
            let fallen = if is_at_rest {
                let (rate, residual) = (stages.rate, stages.residual);
                fallen(problem, &rate, &residual, &floor, CHANGED)
            } else {
                let (rate, residual, floor) = (stages.rate, stages.residual, floor);
                fallen_at_all(problem, &rate, &residual, &floor)
            };
            if let Some(fallen) = fallen {
                floor = fallen;
                per_floor = reciprocals(&floor);
                size = in_units(&stages.residual, &per_floor);
                is_done = !is_at_rest && size <= if is_low { T::one() } else { constant(AT_FLOOR) };
                is_at_rest = false;
                (before, last) = (size * constant(4.0), size);
            }
        }
        if !is_done && iterations > 2 && size >= before * constant(SLUGGISH) {
            let (v, rate, residual) = (v, stages.rate, narrowed(stages.residual));
            // Not that of the guess, which may be far out.
            let now = problem.floor(&rate, &stages.residual);
            match at_rounding(problem, &narrowed(v), &residual, now) {
                Some(measured) => (floor, is_done, is_at_rest) = (measured, true, false),
                None => return None,
            }
        }
        if is_done {
            // What does not contract is left where its residual is known.
            let (mut v, mut remaining) = (v, T::one());
            if is_at_rest {
                let late = iterations > 2 && last * last > size * before;
                let contraction = if late { last / before } else { size / last };
                remaining = if contraction < T::one() { contraction } else { T::one() };
                v = core::array::from_fn(|a| v[a] + stages.correction[a]);
            }
            let report = report(&stages, &floor, remaining, iterations);
            let (v, rate) = (narrowed(v), narrowed(stages.rate));
            return Some(Solution { v, rate, report, solver: C::SOLVER });
        }
        for (v, &correction) in v.iter_mut().zip(&stages.correction) {
            *v = *v + correction;
        }
        (before, last) = (last, size);
    }
    None
}

/// The floor now, if that at the start of the iteration was much lower in a coordinate, one that did not move
/// then: sizes before say nothing of the contraction.
#[cold]
#[inline(never)]
fn risen<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize, const W: usize>(
    problem: &Problem<'_, L, N, S>,
    rate: &LaneVector<T, N, W>,
    residual: &LaneVector<T, N, W>,
    floor: SVector<T, N>,
) -> Option<SVector<T, N>> {
    let now = floor.sup(&problem.floor(rate, residual));
    let has_risen = (0..N).any(|a| now[a] > floor[a] * T::constant(CHANGED));
    has_risen.then_some(now)
}

/// The floor now, if the one that the residual was held against is higher in a coordinate by this factor.
#[cfg_attr(not(debug_assertions), inline(always))]
fn fallen<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize, const W: usize>(
    problem: &Problem<'_, L, N, S>,
    rate: &LaneVector<T, N, W>,
    residual: &LaneVector<T, N, W>,
    floor: &SVector<T, N>,
    factor: f64,
) -> Option<SVector<T, N>> {
    let now = problem.floor(rate, residual);
    let has_fallen = (0..N).any(|a| floor[a] > now[a] * T::constant(factor));
    has_fallen.then_some(now)
}

/// [`fallen`] by any factor, for the few sweeps that end at the floor: apart from the others.
#[cold]
#[inline(never)]
fn fallen_at_all<
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T>,
    const N: usize,
    const S: usize,
    const W: usize,
>(
    problem: &Problem<'_, L, N, S>,
    rate: &LaneVector<T, N, W>,
    residual: &LaneVector<T, N, W>,
    floor: &SVector<T, N>,
) -> Option<SVector<T, N>> {
    fallen(problem, rate, residual, floor, 1.0)
}

/// How an iteration ended whose last correction leaves the share `remaining` of the residual.
#[cfg_attr(not(debug_assertions), inline(always))]
fn report<T: Scalar, const N: usize, const S: usize>(
    stages: &Stages<T, N, S>,
    floor: &SVector<T, N>,
    remaining: T,
    iterations: u32,
) -> Report<T> {
    let (residual, floor) = worst(&stages.residual, floor);
    let last_correction = stages.correction.iter().fold(T::zero(), |largest, c| largest.max(c.amax()));
    Report { iterations, damped: 0, residual: residual * remaining, floor, last_correction }
}
