//! Newton's method for all stages together: for large steps and stiff forces, where the fixed point does not
//! contract.
//!
//! The matrix has (S N)² entries, on the stack; it is assembled anew in each iteration, from the second
//! derivatives at every stage. Steps that do not lower the residual are shortened, unless the one after them
//! is shorter ([`nearer`]), as in the solver of the rules of one stage, whose definition of a solved step
//! this is: `newton/rounding.rs`.

use nalgebra::SVector;

use super::linearised::{Factored, Local, StageVector, locals, non_finite};
use super::noise::{Left, noise};
use super::problem::{Problem, Solution, Solver, in_units_of};
use super::rounding::{at_rounding, is_decided, worst};
use crate::numbers::{
    LaneVector, Scalar,
    lanes::{splat, write_lane},
    nonlinear::MEASURES_NOISE,
};
use crate::step::{
    Report, StepError,
    newton::{AT_FLOOR, SLOW},
};
use crate::system::ForcedLagrangian;

/// As in the solver of the rules of one stage: a few iterations near a root, some dozens from far out.
pub(super) const MAX_ITERATIONS: u32 = 100;

/// An iterate with what was evaluated there.
pub(super) struct Iterate<T, const N: usize, const S: usize> {
    pub(super) v: LaneVector<T, N, S>,
    pub(super) locals: [Local<T, N>; S],
    rate: LaneVector<T, N, S>,
    /// r_i = ∂L/∂v − P_i.
    pub(super) residual: LaneVector<T, N, S>,
    pub(super) floor: SVector<T, N>,
    /// max |r|/floor.
    pub(super) size: T,
}

impl<T: Scalar, const N: usize, const S: usize> Iterate<T, N, S> {
    pub(super) fn new<L: ForcedLagrangian<N, Scalar = T>>(
        problem: &Problem<'_, L, N, S>,
        v: LaneVector<T, N, S>,
    ) -> Self {
        let locals = locals(problem, &v);
        let mut rate = splat(&SVector::zeros());
        let mut own = rate;
        let unit = T::EPSILON * T::constant(4.0);
        let mut terms = SVector::<T, N>::zeros();
        for (i, local) in locals.iter().enumerate() {
            write_lane(&mut rate, i, &local.rate());
            write_lane(&mut own, i, &local.momentum);
            for a in 0..N {
                let sum =
                    (0..N).fold(T::zero(), |sum, b| sum + (local.mass[(a, b)] * v[b].0[i] * unit).abs());
                terms[a] = terms[a].max(sum);
            }
        }
        let momenta = problem.momenta(&rate);
        let residual = core::array::from_fn(|a| own[a] - momenta[a]);
        let floor = problem.floor(&rate, &residual) + terms;
        let size = in_units_of(&residual, &floor);
        Self { v, locals, rate, residual, floor, size }
    }

    /// The size of the residual in units of a floor that two iterates have in common: what they are compared
    /// by.
    pub(super) fn size_in(&self, floor: &SVector<T, N>) -> T {
        in_units_of(&self.residual, floor)
    }

    /// Whether the matrix has grown since `last`, or is none.
    #[cold]
    pub(super) fn has_grown<L: ForcedLagrangian<N, Scalar = T>>(
        &self,
        problem: &Problem<'_, L, N, S>,
        last: &Self,
    ) -> bool {
        let h = problem.h.abs();
        let diagonal = |local: &Local<T, N>, a: usize| {
            let terms = [local.mass[(a, a)], local.rate_by_v[(a, a)] * h, local.rate_by_q[(a, a)] * (h * h)];
            terms.iter().fold(T::zero(), |sum, term| sum + term.abs())
        };
        let mut pairs = self.locals.iter().zip(&last.locals);
        pairs.any(|(now, last)| (0..N).any(|a| diagonal(now, a) > diagonal(last, a) * T::constant(2.0)))
            || self.non_finite().is_some()
    }

    /// Whether a Newton step is at most half as long as `other`, Σ |Mₐₐ| vₐ² here being the square of a
    /// length.
    #[cold]
    pub(super) fn is_half_as_long(&self, step: &StageVector<T, N, S>, other: &StageVector<T, N, S>) -> bool {
        let square = |step: &StageVector<T, N, S>| {
            step.iter().zip(&self.locals).fold(T::zero(), |sum, (step, local)| {
                (0..N).fold(sum, |sum, a| sum + local.mass[(a, a)].abs() * step[a] * step[a])
            })
        };
        square(step) < square(other) * T::constant(0.25)
    }

    pub(super) fn residuals(&self) -> StageVector<T, N, S> {
        core::array::from_fn(|i| crate::numbers::lanes::lane(&self.residual, i))
    }

    /// The first coordinate with an entry that is not finite.
    pub(super) fn non_finite(&self) -> Option<usize> {
        let of_residual = (0..N).find(|&a| self.residual[a].is_finite() != crate::numbers::Mask::splat(true));
        of_residual.or_else(|| non_finite(&self.locals))
    }
}

/// Solves for the stages from the velocities `guess` by at most so many iterations.
#[cold]
#[inline(never)]
pub(super) fn solve<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    guess: &LaneVector<T, N, S>,
    most_iterations: u32,
) -> Result<Solution<T, N, S>, StepError> {
    let one = T::one();
    let constant = T::constant;
    let mut last = Iterate::new(problem, *guess);
    let mut damped = 0;
    for iteration in 0..most_iterations {
        if let Some(index) = last.non_finite() {
            return Err(problem.not_finite(index, &last.v));
        }
        let factored = Factored::new(problem, &last.locals).map_err(|singular| {
            if damped > 0 {
                let residual = worst(&last.residual, &last.floor).0.widen();
                StepError::NoRealSolution { iteration, residual }
            } else {
                StepError::SingularNewtonMatrix { iteration, column: singular.column }
            }
        })?;
        let correction = factored.solve(&last.residuals());
        let last_correction = correction.iter().fold(T::zero(), |largest, c| largest.max(c.amax()));
        let solution = |at: &Iterate<T, N, S>, floor: &SVector<T, N>, damped| {
            let (residual, floor) = worst(&at.residual, floor);
            let report = Report { iterations: iteration + 1, damped, residual, floor, last_correction };
            Solution { v: at.v, rate: at.rate, report, solver: Solver::Newton }
        };

        let mut share = one;
        let next = loop {
            let mut v = last.v;
            for (i, correction) in correction.iter().enumerate() {
                for a in 0..N {
                    v[a].0[i] -= correction[a] * share;
                }
            }
            let next = Iterate::new(problem, v);
            // A coordinate that starts to move only now has no floor to speak of before.
            let floor = last.floor.sup(&next.floor);
            let (size, before) = (next.size_in(&floor), last.size_in(&floor));
            if next.size <= constant(1.0) {
                break Some((next, size / before));
            }
            let lower = size < before;
            if share == one && size.is_finite() && !(lower && size <= before * constant(SLOW)) {
                if nearer(problem, &next, &last, &correction) {
                    break Some((next, size.min(before) / before));
                }
                // No lower than before, or hardly: rounding, if what there is of it explains the residual.
                // One component that rounding holds up can hide that the step has brought the
                // others down.
                for at in [&next, &last].into_iter().take(if lower { 1 } else { 2 }) {
                    if let Some(measured) = at_rounding(problem, &at.v, &at.residual, at.floor) {
                        return Ok(solution(at, &measured, damped));
                    }
                }
                let left = Left {
                    v: &next.v,
                    residual: &next.residual,
                    floor: &next.floor,
                    locals: &next.locals,
                    correction: &correction,
                };
                if MEASURES_NOISE && let Some(measured) = noise(problem, &left, &last.locals) {
                    return Ok(solution(&next, &measured, damped));
                }
            }
            if lower {
                break Some((next, size / before));
            }
            share = crate::step::newton::shorter(share, before, size);
            if share < T::EPSILON.sqrt() {
                break None;
            }
        };
        let Some((next, contraction)) = next else {
            let (residual, floor) = worst(&last.residual, &last.floor);
            let (residual, floor) = (residual.widen(), floor.widen());
            let (limit, mut is_lost) = (T::EPSILON.cbrt(), true);
            for i in 0..S {
                for a in 0..N {
                    is_lost &= correction[i][a].abs() <= limit * last.v[a].0[i].abs();
                }
            }
            return Err(if is_lost {
                StepError::LostPrecision { residual, floor }
            } else {
                StepError::NoRealSolution { iteration, residual }
            });
        };
        damped += u32::from(share < one);
        let contraction = if share < one { one } else { contraction };
        // At the floor, and no better for another correction.
        if next.size <= constant(AT_FLOOR)
            && (contraction > constant(0.01) || next.size <= constant(1.0 / 16.0))
            && is_decided(problem, &next.v, &next.floor)
        {
            return Ok(solution(&next, &next.floor, damped));
        }
        last = next;
    }
    let (residual, floor) = worst(&last.residual, &last.floor);
    Err(StepError::NotConverged {
        iterations: most_iterations,
        residual: residual.widen(),
        floor: floor.widen(),
    })
}

/// Whether a full step whose residual is hardly lower is nearer to the root all the same: the Newton step
/// from there is at most half as long, with Σ |Mₐₐ| vₐ² over all stages for the square of a length, by a
/// matrix that has not grown.
#[cold]
#[inline(never)]
fn nearer<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    next: &Iterate<T, N, S>,
    last: &Iterate<T, N, S>,
    correction: &StageVector<T, N, S>,
) -> bool {
    if next.has_grown(problem, last) {
        return false;
    }
    let Ok(factored) = Factored::new(problem, &next.locals) else { return false };
    last.is_half_as_long(&factored.solve(&next.residuals()), correction)
}
