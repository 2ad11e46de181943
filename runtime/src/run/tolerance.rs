//! Order and step size from a requested error, and a guard that carries the error along the run:
//! [`to_error`](crate::Discretise::to_error).
//!
//! **What is seen.** Steps, half steps at some of them, and the force in the middle and at the ends of some.
//! What happens between these and is over by then is not: a short pulse of force, a contact shorter than a
//! step, a pole of the coordinates or a singular mass that a step passes over. Where that may be, bound the
//! step ([`TimedRequest::longest_step`]), or say when ([`TimedRequest::breaking_at`]).
//!
//! **What is promised.** With the error (δq, δp) of a state, at every step of [`Choice::trajectory`]
//!
//! ```text
//! |δqᵢ| ≤ ε,   w |δpᵢ| ≤ ε   for every i,       ε the tolerance, in units of q
//! w = min(max |qᵢ − qᵢ(0)| / max |pᵢ|,  max |Δqᵢ| / max |Δpᵢ|)
//! ```
//!
//! or a [`Breach`] or an error says that it is not so. The maxima are over the coordinates and the steps so
//! far, Δ is the change over a step: w is 1/(mω) for an oscillator, and weighs a momentum like the coordinate
//! that it moves. The promise rests on an estimate, which random motions have tried: the page
//! `docs/evidence/tolerance.md` counts how often it was kept, passed by more than twice, and where a
//! breach comes late or for nothing.
//!
//! **Choice.** One step of each method, from the start and from the first states of its run, is compared to
//! two half ones, at steps longer and shorter until the tolerance is met: no error is extrapolated
//! below what was tried. The error expected is the sum of these local errors over all steps; it may fill 15 %
//! of the tolerance. Costs are evaluations of the forces, counted: iterations times stages. A method that
//! would usually cost much more than the best one so far is not tried, and trying stops at a tenth of the
//! cost of the run, so that runs of few steps are chosen for by few tries.
//!
//! **Guard.** The first steps do not show chaos, kinks, or a passage that comes later. So the run carries its
//! error along ([`GuardedTrajectory`]), with the exact growth, and reports where it passes the tolerance. The
//! state reached until then is good: [`Breach::instead`] is what to ask for from the start.
//! [`TimedRequest::end`] does so by itself.
//!
//! The step size stays constant along the run, so that the structure is kept, but for what the sweeps of
//! Gauss methods leave: they end where all steps together move the end by a hundredth of the tolerance
//! ([`Choice::slack`], a hundredth of the tolerance over the number of steps). The local errors show it, as
//! the half steps are solved to rounding, so that choice and guard count it in.

mod between;
mod display;
mod drive;
mod estimate;
mod grid;
mod guard;
mod hardest;
mod method;
mod methods;
mod offers;
mod phase;
mod reached;
mod request;
mod scale;
mod search;
mod shift;
mod tangent;
mod twin;
mod unresolved;
mod variation;

use crate::numbers::Scalar;
use crate::rules::SLACK;
pub use crate::run::last_step::LastStep;
use crate::step::{State, StepError, verify_start};
use crate::system::{ActingForce, Lagrangian};
use grid::{Bounds, Breaks, Segment};
pub use guard::{GuardedCheckpoint, GuardedTrajectory};
pub use method::Method;
pub use methods::{MethodStep, Methods, Taken, WithGauss, WithSplittings};
pub use offers::OffersMethods;
pub use reached::Reached;
pub use request::{Request, TimedRequest};

/// One method tried at the start: its step size, and the cost and error expected.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Trial {
    /// The method.
    pub method: Method,
    /// The largest step size tried at which the error expected is small enough, or the one at which it is
    /// smallest.
    pub step_size: f64,
    /// The cost over the whole time, in evaluations of the forces.
    pub evaluations: f64,
    /// The error expected.
    pub expected: f64,
}

/// A method and a step size for a system and its start, with the reasons.
pub struct Choice<'a, L: Lagrangian<N>, M, const N: usize> {
    system: &'a L,
    methods: M,
    chosen: Chosen<L::Scalar, N>,
}

/// The method and step size chosen for a start, with the error and cost expected.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Chosen<S: Scalar, const N: usize> {
    start: State<S, N>,
    method: Method,
    /// The whole time.
    time: f64,
    breaks: Breaks,
    /// The longest step: the only size where nothing breaks.
    step_size: f64,
    steps: u64,
    /// Whether the longest step was given, so that no part of it may go unseen.
    is_watchful: bool,
    tolerance: f64,
    /// The error that the steps are meant for: less than the tolerance where a run before has passed that.
    aim: f64,
    expected: f64,
    /// The local error at the start.
    local: f64,
    evaluations_per_step: f64,
    /// Roundings of a step.
    roundings: f64,
    /// The fastest rate of the motion at the start.
    rate: f64,
    /// The cost of choosing, in evaluations of the forces.
    spent: f64,
    trials: [Option<Trial>; Method::ALL.len()],
}

/// Where the error expected has passed the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Breach {
    /// The time.
    pub time: f64,
    /// The error expected of the state there.
    pub expected: f64,
    /// The tolerance.
    pub tolerance: f64,
    /// A tolerance to ask for instead, from the start.
    pub instead: f64,
}

/// Why no method was chosen.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum ToleranceError {
    /// The time or the tolerance is not a finite number above 0.
    Request {
        /// The time given.
        time: f64,
        /// The tolerance given.
        tolerance: f64,
    },
    /// No method reaches the error: none at a step tried, or rounding over so many steps exceeds it.
    OutOfReach {
        /// The method that comes closest; `None` where no step could be taken.
        closest: Option<Trial>,
    },
    /// The longest step allowed is no number above 0.
    LongestStep {
        /// The step size given.
        step_size: f64,
    },
    /// The most evaluations allowed are no number above 0.
    MostEvaluations {
        /// The number given.
        most: f64,
    },
    /// A time at which the system is said to break is not finite.
    Break {
        /// The time given.
        time: f64,
    },
    /// The error takes more steps than the limit ([`TimedRequest::at_most`]): none was taken but to choose.
    TooManySteps {
        /// Of the methods that reach the error the one of fewest steps.
        needed: Trial,
        /// How many steps.
        steps: f64,
        /// The limit.
        most: u64,
        /// The fastest rate at which the motion changes at the start.
        rate: f64,
    },
    /// The error takes more evaluations of the forces than the limit
    /// ([`TimedRequest::at_most_evaluations`]).
    TooManyEvaluations {
        /// Of the methods that reach the error the one of least cost.
        needed: Trial,
        /// The limit.
        most: f64,
        /// The fastest rate at which the motion changes at the start.
        rate: f64,
    },
    /// Of a system that takes the time and starts at rest: it has not moved wherever it was looked at, so
    /// that nothing can be said of an error.
    NothingMoves {
        /// How often the force was looked at.
        looks: u32,
        /// The time from one to the next.
        apart: f64,
    },
    /// A run cannot be resumed by a system that does not offer its method.
    NotOffered {
        /// The method.
        method: Method,
    },
    /// The caller has stopped the choice, or a run that was tried ([`TimedRequest::stopped_by`]).
    Stopped,
    /// A step at the chosen size failed at the start, or the system is not that written. Of
    /// [`TimedRequest::end`]: or a step on the way, of the last run that was tried.
    Step(StepError),
    /// Of [`TimedRequest::end`]: each run that was tried has passed the error; this is what the last one's
    /// guard reported.
    Breach(Breach),
}

/// The choice for a run over `time` with this error.
fn bounded<'a, L, M, const N: usize>(
    (system, methods): (&'a L, M),
    start: &State<L::Scalar, N>,
    [time, tolerance]: [f64; 2],
    bounds: Bounds<'a>,
) -> Result<Choice<'a, L, M, N>, ToleranceError>
where
    L: ActingForce<N>,
    M: Methods<L, N>,
{
    let valid = |x: f64| x.is_finite() && x > 0.0;
    if !valid(time) || !valid(tolerance) {
        return Err(ToleranceError::Request { time, tolerance });
    }
    bounds.check()?;
    verify_start(system, 0.0, start, true).map_err(ToleranceError::Step)?;
    let choice = search::choice((system, methods), start, [time, tolerance], bounds, None);
    // What was found until then is no choice, nor why there is none.
    if bounds.stop.is_asked() { Err(ToleranceError::Stopped) } else { choice }
}

/// The local error of a step of this order, from its end and that of two half ones.
fn local_error<S: Scalar, const N: usize>(
    order: u32,
    whole: &State<S, N>,
    halves: &State<S, N>,
) -> State<S, N> {
    let power = f64::from(1_u32 << order);
    let factor = S::constant(power / (power - 1.0));
    State { q: (whole.q - halves.q) * factor, p: (whole.p - halves.p) * factor }
}

impl<S: Scalar, const N: usize> Chosen<S, N> {
    /// The first segment of its grid.
    fn first_segment(&self) -> Segment {
        Segment::first(self.time, self.step_size, &self.breaks)
    }

    fn slack(&self) -> Option<f64> {
        let is_left = self.method.is_gauss();
        is_left.then(|| SLACK * self.aim / self.steps as f64)
    }
}

impl<L: Lagrangian<N>, M: Copy, const N: usize> Clone for Choice<'_, L, M, N> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Lagrangian<N>, M: Copy, const N: usize> Copy for Choice<'_, L, M, N> {}

impl<'a, L, M, const N: usize> Choice<'a, L, M, N>
where
    L: ActingForce<N>,
    M: Methods<L, N>,
{
    /// The method chosen: of those that reach the error, the one of least cost.
    pub fn method(&self) -> Method {
        self.chosen.method
    }

    /// The step size, a whole fraction of the time; where the system breaks on the way
    /// ([`TimedRequest::breaking_at`]) the longest one.
    pub fn step_size(&self) -> f64 {
        self.chosen.step_size
    }

    /// Steps over the whole time.
    pub fn steps(&self) -> u64 {
        self.chosen.steps
    }

    /// The tolerance.
    pub fn tolerance(&self) -> f64 {
        self.chosen.tolerance
    }

    /// The largest change, in units of q, that the sweeps of one step may leave unsolved: of Gauss methods,
    /// whose stages are solved no further than the error asks for
    /// ([`Trajectory::solved_for`](crate::Trajectory::solved_for)). `None` of methods that solve to
    /// rounding, or have nothing to solve.
    pub fn slack(&self) -> Option<f64> {
        self.chosen.slack()
    }

    /// The error expected at the end if the whole run is like its start.
    pub fn expected(&self) -> f64 {
        self.chosen.expected
    }

    /// The cost of choosing, in evaluations of the forces.
    pub fn evaluations(&self) -> f64 {
        self.chosen.spent
    }

    /// The trials of the methods that were tried, in the order of [`Method::ALL`].
    pub fn trials(&self) -> impl Iterator<Item = &Trial> {
        self.chosen.trials.iter().flatten()
    }

    /// The run of this choice, with its guard.
    pub fn trajectory(&self) -> GuardedTrajectory<'a, L, M, N> {
        self.run(true)
    }

    /// The run of this choice without its guard, for who knows the motion: nothing is held against the error,
    /// and nothing is spent on it.
    pub fn unguarded(&self) -> GuardedTrajectory<'a, L, M, N> {
        self.run(false)
    }

    fn run(&self, is_guarded: bool) -> GuardedTrajectory<'a, L, M, N> {
        match self.fresh_steps(self.chosen.first_segment().step_size()) {
            Some(steps) => GuardedTrajectory::new(*self, steps, is_guarded),
            _ => unreachable!("the method was tried before it was chosen"),
        }
    }

    /// A step of this size and a half one, before the first.
    ///
    /// The half steps are solved to rounding: beside them it shows what is left of the whole step's stages.
    fn fresh_steps(&self, step_size: f64) -> Option<[M::Step; 2]> {
        let Chosen { method, aim, steps, .. } = self.chosen;
        let step = |h: f64| self.methods.step(method, L::Scalar::constant(h));
        let [mut whole, half] = [step(step_size)?, step(0.5 * step_size)?];
        whole.leave(aim, steps, 0.0);
        Some([whole, half])
    }
}
