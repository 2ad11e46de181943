//! The grid of a run to an error: steps of one size, from each time at which the system breaks to the next.

use nalgebra::ComplexField;

use super::{ToleranceError, Trial};
use crate::step::stop::Stop;

/// Times at which a system may break, at most.
const MOST_BREAKS: usize = 16;

/// The limit of a run's steps unless another is given.
pub(super) const MOST_STEPS: u64 = 10_000_000;

/// Roundings of its time by which a break is kept out of the steps on both sides of it: a node there sees the
/// system of its own side, whichever the body gives the very time to.
const APART: f64 = 8.0 * f64::EPSILON;

/// Bounds of a run's steps, besides the error, and what ends them before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds<'s> {
    /// The limit of their number.
    pub(super) most: u64,
    /// The limit of what they cost, in evaluations of the forces.
    pub(super) costliest: f64,
    /// The longest step; infinite where any is allowed.
    pub(super) longest: f64,
    pub(super) breaks: Breaks,
    pub(super) stop: Stop<'s>,
}

impl Default for Bounds<'_> {
    fn default() -> Self {
        Self {
            most: MOST_STEPS,
            costliest: f64::INFINITY,
            longest: f64::INFINITY,
            breaks: Breaks::default(),
            stop: Stop::never(),
        }
    }
}

impl Bounds<'_> {
    /// Whether they make sense for a run over `time`.
    pub(super) fn check(&self) -> Result<(), ToleranceError> {
        let Self { longest, costliest, breaks, .. } = self;
        if longest.is_nan() || *longest <= 0.0 {
            return Err(ToleranceError::LongestStep { step_size: *longest });
        }
        if costliest.is_nan() || *costliest <= 0.0 {
            return Err(ToleranceError::MostEvaluations { most: *costliest });
        }
        match breaks.times().iter().find(|time| !time.is_finite()) {
            Some(&time) => Err(ToleranceError::Break { time }),
            None => Ok(()),
        }
    }

    /// The share of what is allowed that a run of so many steps takes: above 1 it is not.
    pub(super) fn share(&self, steps: f64, evaluations: f64) -> f64 {
        (steps / self.most as f64).max(evaluations / self.costliest)
    }

    /// The error of a run that takes more than is allowed; at its start the motion changes at `rate`.
    pub(super) fn refusal(&self, needed: Trial, steps: f64, rate: f64) -> ToleranceError {
        let Self { most, costliest, .. } = *self;
        if steps > most as f64 {
            ToleranceError::TooManySteps { needed, steps, most, rate }
        } else {
            ToleranceError::TooManyEvaluations { needed, most: costliest, rate }
        }
    }

    /// Whether the caller has said where there is something to see.
    pub(super) fn are_given(&self) -> bool {
        self.longest.is_finite() || self.breaks.count > 0
    }
}

/// Times at which the system breaks: its force, or another of its functions, jumps or bends.
#[derive(Clone, Copy, Debug, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Breaks {
    times: [f64; MOST_BREAKS],
    count: usize,
}

impl Breaks {
    pub(super) const fn new<const K: usize>(given: [f64; K]) -> Self {
        const { assert!(K <= MOST_BREAKS, "no more than 16 times at which a system breaks") };
        let (mut times, mut count) = ([0.0; MOST_BREAKS], 0);
        while count < K {
            times[count] = given[count];
            count += 1;
        }
        Self { times, count }
    }

    pub(super) fn times(&self) -> &[f64] {
        self.times.get(..self.count).unwrap_or_default()
    }

    /// The first one after `time`, as far as it is one of a run until `end`.
    fn after(&self, time: f64, end: f64) -> Option<f64> {
        let ahead = self.times().iter().copied().filter(|&at| at * (1.0 - APART) > time && at < end);
        ahead.reduce(f64::min)
    }
}

/// Steps of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Segment {
    /// Where it starts and ends.
    from: f64,
    to: f64,
    /// Steps before it, and after it.
    pub(super) steps: [u64; 2],
}

impl Segment {
    /// The one from `from` on, after so many steps: of a run until `end`, by steps of `longest` at most.
    fn starting(from: f64, before: u64, end: f64, longest: f64, breaks: &Breaks) -> Self {
        let to = breaks.after(from, end).map_or(end, |at| at * (1.0 - APART));
        let steps = ComplexField::ceil((to - from) / longest * (1.0 - 1e-12)).max(1.0);
        Self { from, to, steps: [before, before + steps as u64] }
    }

    /// The first of a run.
    pub(super) fn first(end: f64, longest: f64, breaks: &Breaks) -> Self {
        Self::starting(0.0, 0, end, longest, breaks)
    }

    /// The next one; `None` where this is the last.
    pub(super) fn next(&self, end: f64, longest: f64, breaks: &Breaks) -> Option<Self> {
        let from = self.to * ((1.0 + APART) / (1.0 - APART));
        (self.to < end).then(|| Self::starting(from, self.steps[1], end, longest, breaks))
    }

    /// The size of its steps.
    pub(super) fn step_size(&self) -> f64 {
        (self.to - self.from) / (self.steps[1] - self.steps[0]) as f64
    }

    /// The time after so many steps of the run.
    pub(super) fn time(&self, taken: u64) -> f64 {
        self.from + self.step_size() * (taken - self.steps[0]) as f64
    }

    /// Where it starts.
    pub(super) fn from(&self) -> f64 {
        self.from
    }

    /// Where it ends.
    pub(super) fn to(&self) -> f64 {
        self.to
    }
}

/// The segments of a run.
pub(super) fn segments(end: f64, longest: f64, breaks: &Breaks) -> impl Iterator<Item = Segment> {
    let first = Some(Segment::first(end, longest, breaks));
    core::iter::successors(first, move |segment| segment.next(end, longest, breaks))
}
