//! State at any time, of runs by every method: between the nodes of the grid, without leaving it.

mod divisible;
mod moment;
mod times;
mod until;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::rules::Gauss;
use crate::run::Trajectory;
use crate::run::checkpoint::is_same;
pub use crate::run::last_step::LastStep;
use crate::step::{Flow, State, Step, StepError};
pub use divisible::{Divisible, Restartable};
pub use moment::Moment;
pub use times::{SampledAt, TimeError};
pub use until::Until;

/// Looking between the steps.
impl<L, M, const N: usize> Trajectory<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// This run as one that answers for all times of its last step, not only for the ends: [`Dense`].
    ///
    /// ```
    /// use dalembert::{Discretise, Gauss, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = gauss)]
    /// fn oscillator(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    /// }
    /// let start = State::from_velocity(&Oscillator {}, [1.0], [0.0])?;
    /// let mut run = Oscillator {}.by(Gauss::<6>, 0.5).run(start);
    /// let mut dense = run.dense();
    /// for _ in 0..10 {
    ///     dense.next().unwrap()?;
    /// }
    /// // The last step led from 4.5 to 5.
    /// let state = dense.state_at(4.7)?; // to the order of the run, by a step
    /// assert!((state.q[0] - 4.7_f64.cos()).abs() < 1e-13);
    /// let near = dense.interpolated_at(4.7)?; // for nothing, by the polynomial of the stages
    /// assert!((near.q[0] - 4.7_f64.cos()).abs() < 1e-8);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn dense(&mut self) -> Dense<'_, Self, N> {
        Dense::new(self)
    }
}

/// A run whose last step can be looked into: [`Trajectory::dense`].
///
/// An iterator over the very steps of the run, bit by bit: what is asked between them leaves no trace. Two
/// answers:
///
/// | | order | costs |
/// |---|---|---|
/// | [`state_at`](Self::state_at) | that of the run | a step, from the start of the last one |
/// | [`interpolated_at`](Self::interpolated_at), by a [`Gauss`] rule of S ≥ 3 stages | q: S + 1, v: S | nothing but a polynomial |
/// | the same by other methods | q: 4, v: 3, the run's where it is less | the velocities at both ends |
///
/// Gauss rules of three stages and more have the collocation polynomial, v = Σ ℓ_j V_j and q = q0 + h Σ V_j
/// ∫ℓ_j, the others the cubic through (q, v) at both ends. Where the run has structure to keep, the state
/// between should be asked of [`state_at`](Self::state_at): a step keeps what steps keep, a polynomial does
/// not.
pub struct Dense<'t, T: Divisible<N> + ?Sized, const N: usize> {
    run: &'t mut T,
    start: Option<Start<T::Scalar, N>>,
}

/// Where the last step began.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start<S, const N: usize> {
    pub(super) state: State<S, N>,
    pub(super) time: f64,
    /// The step's mean velocity.
    pub(super) mean: SVector<S, N>,
    /// The step's size: less than that of the run where it was shortened.
    pub(super) size: S,
}

/// The nodes of the cubic.
const OF_CUBIC: &[f64] = &Gauss::<2>::NODES;

impl<'t, T: Divisible<N> + ?Sized, const N: usize> Dense<'t, T, N> {
    /// Of `run`, of whatever type, before its next step.
    pub fn new(run: &'t mut T) -> Self {
        Self { run, start: None }
    }
}

impl<T: Divisible<N> + ?Sized, const N: usize> Dense<'_, T, N> {
    /// Whether the method has a polynomial of its own that is better than the cubic through both ends.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn is_collocated(&self) -> bool {
        self.run.nodes().len() > 2
    }

    /// Shares of a step at which it is looked at between its ends.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn nodes(&self) -> &'static [f64] {
        if self.is_collocated() { self.run.nodes() } else { OF_CUBIC }
    }

    /// The run, at the end of the last step.
    #[must_use]
    pub fn run(&self) -> &T {
        self.run
    }

    /// The times of the last step's start and end; `None` before the first.
    #[must_use]
    pub fn interval(&self) -> Option<[f64; 2]> {
        self.start.map(|start| [start.time, self.run.time()])
    }

    /// Whether the run has come to `time`, or to within a few roundings of it; not where that is NaN.
    #[must_use]
    pub fn has_reached(&self, time: f64) -> bool {
        let now = self.run.time();
        let time = on_clock(time, now);
        if self.run.step_size() < T::Scalar::constant(0.0) { time >= now } else { time <= now }
    }

    /// The state at a time of the last step, to the order of the run: by a step from where the last one
    /// began. At the ends it is that of the grid, bit by bit, as at a time that is off the run's clock by no
    /// more than a few roundings. Before the first step there is the start alone.
    ///
    /// # Errors
    /// [`TimeError::Outside`]; [`TimeError::Step`] where a shorter step has no solution although the whole
    /// one has.
    pub fn state_at(&self, time: f64) -> Result<State<T::Scalar, N>, TimeError> {
        if on_clock(time, self.run.time()) == self.run.time() {
            return Ok(*self.run.state());
        }
        let start = self.start_before(time)?;
        Ok(self.partial(&start, T::Scalar::constant(time - start.time))?)
    }

    /// (q, v) at a time of the last step, by a polynomial.
    ///
    /// # Errors
    /// [`TimeError::Outside`]; those of [`State::velocity`], as [`TimeError::Step`].
    pub fn interpolated_at(&self, time: f64) -> Result<Moment<'_, T::System, N>, TimeError> {
        let start = self.start_before(time)?;
        let share = (time - start.time) / start.size.widen();
        let of_method = if self.is_collocated() {
            self.run.last_step().between(&start.state.q, start.size, share)
        } else {
            None
        };
        let [q, v] = match of_method {
            Some(at) => at,
            None => {
                let at_start = self.velocity(start.time, &start.state)?;
                let at_end = self.velocity(self.run.time(), self.run.state())?;
                cubic(&start, &[at_start, at_end], share)
            }
        };
        Ok(Moment::interpolated(self.run.system(), [time, self.run.since()], q, v))
    }

    fn start_before(&self, time: f64) -> Result<Start<T::Scalar, N>, TimeError> {
        let now = self.run.time();
        match self.start {
            Some(start) if start.time.min(now) <= time && time <= start.time.max(now) => Ok(start),
            _ => Err(self.outside(time)),
        }
    }

    /// The error of a time that is not one of the last step.
    pub(super) fn outside(&self, time: f64) -> TimeError {
        let now = self.run.time();
        TimeError::Outside { time, from: self.start.map_or(now, |start| start.time), to: now }
    }

    /// The system.
    pub(super) fn system(&self) -> &T::System {
        self.run.system()
    }

    pub(super) fn start(&self) -> Option<&Start<T::Scalar, N>> {
        self.start.as_ref()
    }

    /// The state `elapsed` after the start of the last step.
    pub(super) fn partial(
        &self,
        start: &Start<T::Scalar, N>,
        elapsed: T::Scalar,
    ) -> Result<State<T::Scalar, N>, StepError> {
        if elapsed == T::Scalar::constant(0.0) {
            return Ok(start.state);
        }
        let (system, begun) = (self.system(), start.time - self.since());
        self.run.last_step().beginning(system, begun, &start.state, &start.mean, [start.size, elapsed])
    }

    /// The time of the run at which the system has its own.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn since(&self) -> f64 {
        self.run.since()
    }

    /// The velocity of a state of the run.
    #[inline]
    pub(super) fn velocity(
        &self,
        time: f64,
        state: &State<T::Scalar, N>,
    ) -> Result<SVector<T::Scalar, N>, StepError> {
        self.run.last_step().velocity(self.system(), time - self.since(), state)
    }

    /// Calls `visit` with moments on the chord of the last step, by its mean velocity.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn at_chord(
        &self,
        start: &Start<T::Scalar, N>,
        mut visit: impl FnMut(&Moment<'_, T::System, N>),
    ) {
        let (system, since, h) = (self.run.system(), self.run.since(), start.size);
        for &share in OF_CUBIC {
            let elapsed = h * T::Scalar::constant(share);
            let time = start.time + elapsed.widen();
            let q = start.state.q + start.mean * elapsed;
            visit(&Moment::interpolated(system, [time, since], q, start.mean));
        }
    }

    /// The moment at `time` by the cubic through the last step's ends with their velocities, beyond the step
    /// as well.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn on_cubic(
        &self,
        start: &Start<T::Scalar, N>,
        ends: &[SVector<T::Scalar, N>; 2],
        time: f64,
    ) -> Moment<'_, T::System, N> {
        let [q, v] = cubic(start, ends, (time - start.time) / start.size.widen());
        Moment::interpolated(self.run.system(), [time, self.run.since()], q, v)
    }

    /// Calls `visit` with the last step's moments at [`nodes`](Self::nodes); `ends` are the velocities there,
    /// asked for where the method has no polynomial.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn at_nodes(
        &self,
        start: &Start<T::Scalar, N>,
        ends: &[SVector<T::Scalar, N>; 2],
        mut visit: impl FnMut(usize, &Moment<'_, T::System, N>),
    ) {
        let (system, since, h) = (self.run.system(), self.run.since(), start.size);
        let time = |share: f64| start.time + share * h.widen();
        if self.is_collocated() {
            self.run.last_step().at_nodes(&start.state.q, h, &mut |i, q, v| {
                let share = self.nodes().get(i).copied().unwrap_or(1.0);
                visit(i, &Moment::interpolated(system, [time(share), since], *q, *v));
            });
        } else {
            for (i, &share) in self.nodes().iter().enumerate() {
                let [q, v] = cubic(start, ends, share);
                visit(i, &Moment::interpolated(system, [time(share), since], q, v));
            }
        }
    }
}

/// The time, or the clock where they differ by a few roundings of either.
fn on_clock(time: f64, clock: f64) -> f64 {
    if is_same(time, clock) { clock } else { time }
}

/// (q, v) at a share τ of a step, by the cubic with q and v at both ends.
#[cfg_attr(not(debug_assertions), inline(always))]
fn cubic<S: Scalar, const N: usize>(
    start: &Start<S, N>,
    [v0, v1]: &[SVector<S, N>; 2],
    share: f64,
) -> [SVector<S, N>; 2] {
    let of = S::constant;
    let rest = 1.0 - share;
    let (mean, bend) = (start.mean, share * rest);
    // q0 + τh [v̄ + (1 − τ)((1 − τ)(v0 − v̄) − τ (v1 − v̄))], and its derivative.
    let (at_start, at_end) = (v0 - mean, v1 - mean);
    let q = mean * of(share) + at_start * of(bend * rest) - at_end * of(bend * share);
    let v = mean + at_start * of(rest * (1.0 - 3.0 * share)) + at_end * of(share * (3.0 * share - 2.0));
    [start.state.q + q * start.size, v]
}

impl<T: Restartable<N>, const N: usize> Dense<'_, T, N> {
    /// Leaves the grid: the run goes on from `state` at `time`.
    pub(super) fn restart_at(&mut self, time: f64, state: State<T::Scalar, N>) {
        self.run.restart_at(time, state);
        self.start = None;
    }

    /// The next step, no further than `end`; `None` where the run is there, or has ended.
    pub(super) fn next_until(&mut self, end: f64) -> Option<Result<Step<T::Scalar, N>, StepError>> {
        let (state, time) = (*self.run.state(), self.run.time());
        let step = self.run.next_until(end)?;
        Some(step.map(|(step, size)| {
            self.start = Some(Start { state, time, mean: step.velocity, size });
            step
        }))
    }
}

impl<'a, L: Flow<M, N>, M, const N: usize> Dense<'_, Trajectory<'a, L, M, N>, N> {
    /// Leaves the grid, as [`restart_at`](Self::restart_at), and the system.
    pub(super) fn restart_with(&mut self, system: &'a L, state: State<L::Scalar, N>) {
        self.run.restart_with(system, state);
        self.start = None;
    }
}

impl<T: Divisible<N> + ?Sized, const N: usize> Iterator for Dense<'_, T, N> {
    type Item = Result<Step<T::Scalar, N>, StepError>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let (state, time) = (*self.run.state(), self.run.time());
        let step = self.run.next();
        if let Some(Ok(step)) = &step {
            self.start = Some(Start { state, time, mean: step.velocity, size: self.run.step_size() });
        }
        step
    }
}
