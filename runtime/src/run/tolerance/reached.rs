//! The end of a run that keeps the tolerance, whatever its start shows of it.

use nalgebra::ComplexField;

use super::grid::{Bounds, segments};
use super::hardest::Hardest;
use super::{Breach, Choice, Chosen, Methods, ToleranceError, Trial, bounded, search};
use crate::numbers::Scalar;
use crate::step::{State, StepError};
use crate::system::{ActingForce, Lagrangian};

/// Runs to the end at most.
const RUNS: u32 = 8;

/// The share of the tolerance that the next run is to come to, if its error goes with the one aimed at.
const AIM: f64 = 0.3;

/// The share of the tolerance that a run after the first may be expected to come to: the more runs are tried,
/// the likelier one is taken for good whose error is underrated.
const ACCEPTED: f64 = 0.7;

/// The share of an aim that the next one is at least: errors as large as the motion say little.
const LEAST: f64 = 1e-5;

/// The error expected, over the tolerance, beyond which a run ends: it has shown where it errs.
pub(super) const HOPELESS: f64 = AIM / LEAST;

/// By so much the steps of a method are shortened, where no method is expected to reach a smaller error.
const SHORTER: [f64; 2] = [1.1, 4.0];

/// The end of a motion to an error that was asked for, and the run that has kept it:
/// [`TimedRequest::end`](super::TimedRequest::end).
#[derive(Debug)]
pub struct Reached<'a, L: Lagrangian<N>, M, const N: usize> {
    /// The state at the end.
    pub state: State<L::Scalar, N>,
    /// The error expected of it.
    pub expected: f64,
    /// The method and step size, whose [`trajectory`](Choice::trajectory) is this run once more, without a
    /// breach.
    pub choice: Choice<'a, L, M, N>,
    /// How many runs it took, this one among them.
    pub runs: u32,
    /// The cost of them all, with choices and guards, in evaluations of the forces.
    pub evaluations: f64,
}

/// A run that was followed to its end, or until a step of it failed.
pub(super) struct Followed<S: Scalar, const N: usize> {
    pub(super) state: State<S, N>,
    pub(super) expected: f64,
    /// The largest error expected on the way.
    pub(super) largest: f64,
    pub(super) hardest: Hardest<S, N>,
    pub(super) breach: Option<Breach>,
    pub(super) failure: Option<StepError>,
    /// How many steps it took.
    pub(super) steps: u64,
    /// The cost of its steps and its guard.
    pub(super) evaluations: f64,
}

/// Takes the run of a choice.
type Follow<'f, 'a, L, M, const N: usize> =
    dyn FnMut(&Choice<'a, L, M, N>) -> Followed<<L as Lagrangian<N>>::Scalar, N> + 'f;

/// Runs to the end with smaller and smaller errors aimed at, until the guard finds that one keeps the
/// tolerance; `follow` takes the steps.
pub(super) fn reached<'a, L, M, const N: usize>(
    (system, methods): (&'a L, M),
    start: &State<L::Scalar, N>,
    [time, tolerance]: [f64; 2],
    bounds: Bounds<'a>,
    follow: &mut Follow<'_, 'a, L, M, N>,
) -> Result<Reached<'a, L, M, N>, ToleranceError>
where
    L: ActingForce<N>,
    M: Methods<L, N>,
{
    let mut aim = tolerance;
    let mut choice = bounded((system, methods), start, [time, tolerance], bounds)?;
    let (mut runs, mut taken, mut evaluations) = (1, 0.0, 0.0);
    loop {
        let run = follow(&choice);
        taken += run.steps as f64;
        evaluations += choice.chosen.spent + run.evaluations;
        if bounds.stop.is_asked() {
            return Err(ToleranceError::Stopped);
        }
        let is_clear = run.largest <= ACCEPTED * tolerance;
        let (largest, error) = match (run.failure, run.breach) {
            (None, None) if runs == 1 || runs == RUNS || is_clear => {
                let Followed { state, expected, .. } = run;
                return Ok(Reached { state, expected, choice, runs, evaluations });
            }
            (None, None) => (run.largest, None),
            (None, Some(breach)) => (run.largest, Some(ToleranceError::Breach(breach))),
            (Some(error), _) => (f64::INFINITY, Some(ToleranceError::Step(error))),
        };
        if let (RUNS, Some(error)) = (runs, error) {
            return Err(error);
        }
        runs += 1;
        let share = AIM * tolerance / largest;
        // The first one was chosen without what it has found.
        let most = if runs == 2 { aim } else { AIM * aim };
        aim = most.min(tolerance / run.hardest.growth(run.largest).min(1.0 / LEAST));
        let passage = Some(run.hardest);
        choice = match search::choice((system, methods), start, [time, aim], bounds, passage) {
            // The start may show nothing of what comes: the same run would only end as the last one did.
            Ok(next) if !choice.is_no_shorter(&next) => next,
            Ok(_) => choice.shortened(share, aim),
            // The rounding of so many steps, a step that fails, or a stop, which ends the next run.
            Err(_) => choice.shortened(share, aim),
        };
        choice.chosen.tolerance = tolerance;
        let Chosen { steps, rate, .. } = choice.chosen;
        let (steps, needed) = (taken + steps as f64, choice.chosen.trial());
        if bounds.share(steps, evaluations + needed.evaluations) > 1.0 {
            return Err(error.unwrap_or_else(|| bounds.refusal(needed, steps, rate)));
        }
    }
}

impl<S: Scalar, const N: usize> Chosen<S, N> {
    /// Its method and step size, as they would be tried.
    fn trial(&self) -> Trial {
        let Self { method, step_size, steps, expected, evaluations_per_step, .. } = *self;
        Trial { method, step_size, evaluations: steps as f64 * evaluations_per_step, expected }
    }
}

impl<L, M, const N: usize> Choice<'_, L, M, N>
where
    L: ActingForce<N>,
    M: Methods<L, N>,
{
    /// Whether `next` takes the same steps, or as long ones.
    fn is_no_shorter(&self, next: &Self) -> bool {
        let (last, next) = (&self.chosen, &next.chosen);
        next.method == last.method && next.step_size * SHORTER[0] > last.step_size
    }

    /// This choice with h divided by share^(−1/p), p the order; the divisor is kept within [`SHORTER`].
    fn shortened(mut self, share: f64, aim: f64) -> Self {
        let p = f64::from(self.chosen.method.order());
        let [least, most] = SHORTER;
        let factor = ComplexField::powf(share, -1.0 / p).clamp(least, most);
        self.chosen.local *= ComplexField::powf(factor, -1.0 - p);
        self.chosen.expected *= ComplexField::powf(factor, -p);
        let chosen = &mut self.chosen;
        let nominal = ComplexField::ceil(chosen.time / chosen.step_size * factor);
        (chosen.step_size, chosen.aim) = (chosen.time / nominal, aim);
        let last = segments(chosen.time, chosen.step_size, &chosen.breaks).last();
        chosen.steps = last.map_or(chosen.steps, |segment| segment.steps[1]);
        self
    }
}
