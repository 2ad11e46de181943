//! The slack of sweeps: the change that they may leave unmade, where an error is asked for at an end.
//!
//! A share of 1/100 of that error is spread evenly over the steps: its part of one step is the slack. With
//! sweeps whose residuals in momenta are r and whose corrections of velocities are c, a step errs by what the
//! sweeps after the last would still change,
//!
//! ```text
//! |δq1| ≤ h |Σ c|,   |δp1| ≤ |Σ r|,   sums over the sweeps not made, of the contraction measured
//! ```
//!
//! and both stay below the slack, δp1 weighed by w = max |Δq|/max |Δp| over the steps so far. Lanes of many
//! members take the same decisions: they are functions of numbers alone.

use super::problem::{Problem, Solution, Solver, in_width};
use crate::numbers::{
    Blank, LaneVector, Lanes, Scalar,
    lanes::{narrowed, widened},
};
use crate::step::{Report, State};
use crate::system::{ForcedLagrangian, Stages};

/// The share of the tolerance that unsolved stages may make.
pub(crate) const SLACK: f64 = 0.01;

/// More sweeps than a smaller slack would cost elsewhere.
pub(super) const MAX_SWEEPS: u32 = 60;

/// Two sweeps that leave more of the residual than this are no contraction to rely on.
const SLUGGISH: f64 = 0.5;

/// Below so many roundings of a momentum the slack is no more than rounding.
pub(super) const ROUNDINGS: f64 = 8.0;

/// How many steps of size `h` lead to `time`; where that is nearly a whole number, the last is one of them.
pub(crate) fn steps_until(time: f64, h: f64) -> u64 {
    nalgebra::ComplexField::ceil((time / h).max(0.0) - 1e-6) as u64
}

/// The error that unsolved stages may make in each of the next steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slack<T> {
    /// In units of q.
    pub(super) of_step: T,
    /// The steps that it was meant for and that are still to come.
    pub(super) steps: u64,
    /// The largest change of a coordinate and of a momentum over a step; before the first what stands for
    /// them.
    pub(super) change: [T; 2],
}

impl<T: Scalar> Slack<T> {
    /// For an error of `error` after so many steps, with what an error of p counts beside one of q at first;
    /// 0 where that is not known.
    pub(crate) fn new(error: f64, steps: u64, weight: f64) -> Self {
        let of_step = SLACK * error / steps.max(1) as f64;
        // So small that the first step's changes take their place.
        let small = T::SMALLEST_NORMAL.sqrt();
        Self { of_step: T::constant(of_step), steps, change: [T::constant(weight) * small, small] }
    }

    /// Takes in a step.
    #[inline]
    pub(crate) fn follow<const N: usize>(&mut self, from: &State<T, N>, to: &State<T, N>) {
        self.steps = self.steps.saturating_sub(1);
        self.change =
            [self.change[0].max((to.q - from.q).amax()), self.change[1].max((to.p - from.p).amax())];
    }

    /// The allowance for the sweeps of the next step, of size `h` from the momentum `p`; `None` before the
    /// first step has shown how q and p change, after the last, and where it were no more than rounding.
    #[inline]
    pub(crate) fn allowance<const N: usize>(
        &self,
        h: T,
        p: &nalgebra::SVector<T, N>,
    ) -> Option<Allowance<T>> {
        let [q_change, p_change] = self.change;
        let rounding = T::EPSILON * T::constant(ROUNDINGS) * p.amax() * q_change;
        let is_known = self.steps > 0 && q_change > T::zero() && self.of_step * p_change > rounding;
        is_known.then(|| Allowance {
            per_correction: h.abs() / self.of_step,
            per_residual: q_change / (p_change * self.of_step),
            residual: self.of_step * p_change / q_change,
        })
    }
}

/// The change that the sweeps of one step may leave unmade, as a unit of corrections and residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Allowance<T> {
    /// The factor from corrections of V to this unit.
    pub(crate) per_correction: T,
    /// The factor from residuals of the momenta to this unit.
    pub(crate) per_residual: T,
    /// The unit, as a residual of a momentum.
    residual: T,
}

impl<T: Scalar> Allowance<T> {
    /// The largest residual and correction in these units; not finite where one is not.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn size<const N: usize, const S: usize>(&self, stages: &Stages<T, N, S>) -> T {
        let mut largest = Lanes::<T, S>::splat(T::zero());
        let mut sum = largest;
        for a in 0..N {
            let residual = stages.residual[a].abs() * self.per_residual;
            let correction = stages.correction[a].abs() * self.per_correction;
            largest = largest.larger(residual.larger(correction));
            // In the sum NaN and infinity stay.
            sum = sum + (residual + correction);
        }
        largest.largest_unless(sum)
    }
}

/// The change that sweeps still to be made would add, in units of the present size, by the last three sizes,
/// the present one last; infinite where they do not contract.
///
/// Where the mass depends on q, velocities follow momenta a sweep late, and every other sweep may take off
/// less: of the last two contractions x and y the larger is expected of the next sweep, and x y of any two.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(crate) fn remaining<T: Scalar>([before, last, now]: [T; 3]) -> T {
    let (x, y) = (last / before, now / last);
    let both = x * y;
    let larger = if x > y { x } else { y };
    if both < T::constant(SLUGGISH) && larger.is_finite() {
        larger * (T::one() + larger) / (T::one() - both)
    } else {
        T::one() / T::zero()
    }
}

/// How sweeps within an allowance ended.
pub(super) enum Swept<T, const N: usize, const S: usize> {
    /// The change left is within the allowance.
    Within(Solution<T, N, S>),
    /// The sweeps no longer contract: to be solved from here to rounding, after so many of them.
    Slow(LaneVector<T, N, S>, u32),
    /// The sweeps lead nowhere.
    Lost,
}

/// Sweeps from the velocities `guess` until what is left is within the allowance.
#[inline]
pub(super) fn sweep<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    guess: &LaneVector<T, N, S>,
    allowance: &Allowance<T>,
) -> Swept<T, N, S> {
    in_width!(sweep_in::<T, L; N, S>(problem, guess, allowance))
}

#[inline(never)]
fn sweep_in<T, L, const N: usize, const S: usize, const W: usize>(
    problem: &Problem<'_, L, N, S>,
    guess: &LaneVector<T, N, S>,
    allowance: &Allowance<T>,
) -> Swept<T, N, S>
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T>,
{
    let mut v: LaneVector<T, N, W> = widened(*guess);
    let mut anchors = L::Anchors::<W>::blank();
    let (mut before, mut last) = (T::zero(), T::zero());
    for iterations in 1..=MAX_SWEEPS {
        let stages = problem.next_stages(&mut anchors, &v);
        let size = allowance.size(&stages);
        if !size.is_finite() {
            return Swept::Lost;
        }
        for (v, &correction) in v.iter_mut().zip(&stages.correction) {
            *v = *v + correction;
        }
        if iterations > 2 {
            let share = remaining([before, last, size]);
            if size * share <= T::one() {
                let last_correction =
                    stages.correction.iter().fold(T::zero(), |largest, c| largest.max(c.amax()));
                let left = size * share * allowance.residual;
                let floor = allowance.residual;
                let report = Report { iterations, damped: 0, residual: left, floor, last_correction };
                let (v, rate) = (narrowed(v), narrowed(stages.rate));
                return Swept::Within(Solution { v, rate, report, solver: Solver::FixedPoint });
            }
            if !share.is_finite() {
                return Swept::Slow(narrowed(v), iterations);
            }
        }
        (before, last) = (last, size);
    }
    Swept::Slow(narrowed(v), MAX_SWEEPS)
}
