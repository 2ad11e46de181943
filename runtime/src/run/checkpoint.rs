//! Runs as they can be saved, and what holds up a run: a system that is not the one written, its end, and a
//! clock that no longer runs.

use crate::numbers::Scalar;
use crate::step::{Flow, Memory, State, StepError, verify_start};
use crate::system::Lagrangian;

/// By how much of its size a step may be longer so that it ends at a time: a step of what would be left is no
/// step that anyone asked for.
const LONGER: f64 = 1.0 / 1024.0;

/// A run as it can be saved; see [`Trajectory::checkpoint`](crate::Trajectory::checkpoint). With the feature
/// `serde` it can be written and read.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Checkpoint<S, const N: usize> {
    /// The state.
    #[cfg_attr(
        feature = "serde",
        serde(bound(
            serialize = "S: Scalar + serde::Serialize",
            deserialize = "S: Scalar + serde::Deserialize<'de>"
        ))
    )]
    pub state: State<S, N>,
    /// The step size h.
    pub step_size: S,
    /// The time at which the present step size began.
    pub origin: f64,
    /// Steps taken with it.
    pub steps: u64,
}

impl<S: Scalar, const N: usize> Checkpoint<S, N> {
    /// The start of a run with step size `step_size` from `state`, at time 0.
    pub fn new(step_size: S, state: State<S, N>) -> Self {
        Self { state, step_size, origin: 0.0, steps: 0 }
    }

    /// The time, h × the number of steps taken (and what earlier step sizes took): no sum of roundings.
    pub fn time(&self) -> f64 {
        // Without a step the product would be NaN for a step size that is not finite.
        if self.steps == 0 { self.origin } else { self.time_after(self.steps as f64) }
    }

    fn time_after(&self, steps: f64) -> f64 {
        self.origin + self.step_size.widen() * steps
    }

    /// The next step on the way to `end`.
    pub(super) fn toward(&self, end: f64) -> Toward<S> {
        let (now, h) = (self.time(), self.step_size.widen());
        let left = end - now;
        let steps = left / h;
        if h == 0.0 || !h.is_finite() || steps > 1.0 + LONGER {
            // A step size that is none is the step's to refuse.
            Toward::Grid
        } else if steps <= 0.0 {
            Toward::Nowhere
        } else if is_same(end, self.time_after(self.steps as f64 + 1.0)) {
            Toward::Last(self.step_size)
        } else {
            Toward::Last(S::constant(left))
        }
    }

    /// Goes on from `end` by the clock.
    pub(super) fn arrive(&mut self, end: f64) {
        (self.origin, self.steps) = (end, 0);
    }

    /// Takes the clock for `end` where it differs by a few roundings.
    pub(super) fn settle(&mut self, end: f64) {
        if is_same(end, self.time()) {
            self.arrive(end);
        }
    }

    /// One step further. [`Course`] keeps the number of steps far from its largest value.
    pub(crate) fn follow(&mut self, state: &State<S, N>) {
        self.state = *state;
        self.steps += 1;
    }
}

/// The next step on the way to a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Toward<S> {
    /// None: the run is past it, or stands there.
    Nowhere,
    /// One of the run's own size, which does not lead there.
    Grid,
    /// The last, of this size.
    Last(S),
}

/// Whether a time is that of the clock but for a few roundings.
pub(super) fn is_same(time: f64, clock: f64) -> bool {
    nalgebra::ComplexField::abs(time - clock) <= 8.0 * f64::EPSILON * nalgebra::ComplexField::abs(clock)
}

/// The stage of a run: which check its next step needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Course {
    /// Before the first step: whether the system is the one written.
    Starting,
    /// Before the first step of another size, or of one more of several runs: whether its values are those
    /// written. The slopes were looked at.
    Beginning,
    /// No check: the clock resolves more steps than a computer takes, or the step itself refuses its size.
    Open,
    /// Whether the next step can be told from none by the clock.
    Watched,
    /// The run has ended.
    Ended,
}

impl Course {
    /// Steps that a clock without an origin tells apart, with some to spare: at 10 ns a step, a year.
    const STEPS: u64 = 1 << 52;

    /// The course of a run that has started, at `checkpoint`.
    fn of<S: Scalar, const N: usize>(checkpoint: &Checkpoint<S, N>) -> Self {
        let (h, origin) = (checkpoint.step_size.widen().abs(), checkpoint.origin.abs());
        // A step size that is none is the step's to refuse.
        let is_none = h == 0.0 || !h.is_finite();
        let resolves = checkpoint.steps <= Self::STEPS && origin <= h * Self::STEPS as f64 && h <= 1e280;
        if is_none || resolves { Self::Open } else { Self::Watched }
    }

    /// The course once the step size is another.
    pub(crate) fn resized(self) -> Self {
        match self {
            Self::Open | Self::Watched => Self::Beginning,
            // A run that has ended may not have begun.
            Self::Starting | Self::Beginning | Self::Ended => Self::Starting,
        }
    }

    /// The course once the clock is another.
    pub(crate) fn moved<S: Scalar, const N: usize>(self, at: &Checkpoint<S, N>) -> Self {
        match self {
            Self::Open | Self::Watched => Self::of(at),
            Self::Starting | Self::Beginning | Self::Ended => self,
        }
    }

    /// Fails before the first step of a system that is not the one written, and where the clock does not tell
    /// the next step from none.
    pub(crate) fn require<L: Lagrangian<N>, const N: usize>(
        &mut self,
        system: &L,
        at: &Checkpoint<L::Scalar, N>,
    ) -> Result<(), StepError> {
        *self = self.checked(system, at.time(), at)?;
        Ok(())
    }

    /// As [`require`](Self::require), and before the first step also where that is another than the
    /// derivatives of L_d and f_d say.
    pub(crate) fn require_step<L: Flow<M, N>, K: Memory<L, M, N>, M, const N: usize>(
        &mut self,
        system: &L,
        at: &Checkpoint<L::Scalar, N>,
    ) -> Result<(), StepError> {
        *self = self.of_step::<L, K, M, N>(system, at.time(), at)?;
        Ok(())
    }

    /// As [`require_step`](Self::require_step), of a `system` that has the time of this step: the course once
    /// the step is taken.
    #[inline]
    pub(crate) fn after<L: Flow<M, N>, K: Memory<L, M, N>, M, const N: usize>(
        self,
        system: &L,
        at: &Checkpoint<L::Scalar, N>,
    ) -> Result<Self, StepError> {
        if self == Self::Open { Ok(self) } else { self.of_step::<L, K, M, N>(system, 0.0, at) }
    }

    fn of_step<L: Flow<M, N>, K: Memory<L, M, N>, M, const N: usize>(
        self,
        system: &L,
        elapsed: f64,
        at: &Checkpoint<L::Scalar, N>,
    ) -> Result<Self, StepError> {
        let course = self.checked(system, elapsed, at)?;
        if self == Self::Starting {
            let elapsed = L::Scalar::constant(elapsed);
            system.later(elapsed, |system| K::verify_momenta(system, &at.state, at.step_size))?;
        }
        Ok(course)
    }

    #[cold]
    #[inline(never)]
    fn checked<L: Lagrangian<N>, const N: usize>(
        self,
        system: &L,
        elapsed: f64,
        at: &Checkpoint<L::Scalar, N>,
    ) -> Result<Self, StepError> {
        let course = if matches!(self, Self::Starting | Self::Beginning) {
            verify_start(system, elapsed, &at.state, self == Self::Starting)?;
            Self::of(at)
        } else {
            self
        };
        course.require_time(at)?;
        Ok(course)
    }

    /// Fails where the end of the next step has the time of its start, or none.
    fn require_time<S: Scalar, const N: usize>(self, at: &Checkpoint<S, N>) -> Result<(), StepError> {
        let (now, next) = (at.time(), at.time_after(at.steps as f64 + 1.0));
        if self != Self::Watched || (now.is_finite() && next.is_finite() && now != next) {
            return Ok(());
        }
        Err(StepError::Time { time: now, h: at.step_size.widen() })
    }
}
