//! Events of runs by every method: when a function of the motion vanishes, to rounding, and what follows.

mod error;
mod event;
mod nodes;
mod on_step;
mod range;
mod roots;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::run::between::{Dense, Divisible, Moment, Restartable, Start};
use crate::run::{Run, Trajectory};
use crate::step::{Flow, State, Step, StepError};
pub use error::EventError;
pub use event::{Event, EventDerivatives, EventGradient};
use nodes::Nodes;
use on_step::Found;
use range::{BY_CHORD, BY_CUBIC, Range, missed};
pub use roots::Passage;
use roots::ROOTS;

/// Restarts without a step between that count as chattering.
const RESTARTS: u32 = 256;

/// Watching for events.
impl<L, M, const N: usize> Trajectory<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// Watches this run for the events that the functions `g` vanish: [`Watch`], an iterator over them.
    ///
    /// Without [`until`](Watch::until) it takes steps until there is an event, or the run ends.
    ///
    /// ```
    /// use dalembert::run::events::Crossing;
    /// use dalembert::{Discretise, Splitting, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = trapezoidal)]
    /// fn oscillator(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    /// }
    /// let start = State::from_velocity(&Oscillator {}, [1.0], [0.0])?;
    /// let mut run = Oscillator {}.by(Splitting::blanes_casas_escorihuela_8(), 0.25).run(start);
    /// let mut periods = 0.0;
    /// for event in run.watch(|at| [at.q[0]]).crossing([Crossing::Rising]).until(100.0) {
    ///     periods += 1.0;
    ///     assert!((event?.time / (periods - 0.25) - std::f64::consts::TAU).abs() < 1e-8);
    /// }
    /// assert_eq!(periods, 16.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn watch<G, const K: usize>(&mut self, g: G) -> Watch<'_, Self, G, N, K>
    where
        G: Fn(&Moment<'_, L, N>) -> [L::Scalar; K],
    {
        Watch::new(self, g)
    }
}

/// Which events count, by the direction in which the function passes 0 as the run goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Crossing {
    /// All, touching among them.
    #[default]
    Either,
    /// Passages from below.
    Rising,
    /// Passages from above.
    Falling,
}

/// A run that is watched for events: [`Trajectory::watch`].
///
/// **What is found.** Every root of g along the run, from after its start on. A step is asked at its ends and
/// between, at the stages of a [`Gauss`](crate::Gauss) rule (of three stages at least) or, by other methods,
/// on the cubic through both ends with their velocities, which is held against the step before. Where the
/// polynomial through these values has no root, even with what it may be off by, there is none; where it does
/// not say, true values are asked for, by partial steps. So two roots within a step are found as one is. Each
/// is refined by partial steps to rounding. They come in the order of time, several at one time in that of
/// their functions.
///
/// The error of a polynomial is estimated, as functions have no bounds to ask for. Of two million random
/// crossings by all methods, a third of them in steps with several, none was missed; of two million pairs
/// that lie closer together than a fiftieth of a step, four were, all in steps of a radian and more.
///
/// **How often.** Each once, as a [`Passage`], whatever rounding makes of it:
///
/// | g | is told |
/// |---|---|
/// | passes 0, smoothly, at a corner or by a jump | once, as `Rising` or `Falling` |
/// | touches 0 and turns back, smoothly or at a corner | once, as `Touching` |
/// | has several roots that rounding does not tell apart | once, by its sides before and after |
/// | is 0 on an interval | as `Touching` where that begins, as a passage where it ends on the other side |
/// | is 0 where the run starts | not before it has left |
/// | comes no nearer to 0 than rounding, of the state and of the steps before | not at all |
///
/// A root at the end of a step belongs to that step. Of 60 000 random functions, products of up to four
/// factors of all these kinds in steps with several or none, all smooth ones were told so; of those with
/// jumps and corners 348 were not, where several in one step hide one another, and 42 were an error, with a
/// jump at a node of the grid.
///
/// **The run** takes the same steps as unwatched, bit by bit, unless it ends at a
/// [`terminal`](Self::terminal) event or at a time ([`until`](Self::until)): there it stands at the event's
/// time and state, its memory forgotten. [`restart`](Self::restart) goes on from there, from another state
/// perhaps. Where impacts accumulate, or a restart presses against the surface that it is on, the next is
/// [`EventError::Chattering`], and the run stands at the last one.
///
/// A pendulum against a stop, with restitution:
///
/// ```
/// use dalembert::run::events::Crossing;
/// use dalembert::{Discretise, Gauss, State, rayleigh_system};
///
/// #[rayleigh_system(rule = gauss)]
/// fn pendulum(q: [f64; 1], v: [f64; 1]) -> f64 {
///     0.5 * v[0] * v[0] + q[0].cos()
/// }
/// let start = State::from_velocity(&Pendulum {}, [1.0], [0.0])?;
/// let mut run = Pendulum {}.by(Gauss::<8>, 0.25).run(start);
/// let mut watch = run.watch(|at| [at.q[0] + 0.1]).crossing([Crossing::Falling]).terminal([true]);
/// for _ in 0..10 {
///     let impact = watch.next().unwrap()?;
///     watch.restart(State { q: impact.state.q, p: impact.state.p * -0.9 });
/// }
/// // The kinetic energy at the stop falls by 0.81 at every impact.
/// let left = 0.81_f64.powi(10) * (0.1_f64.cos() - 1.0_f64.cos());
/// let now = run.state().energy(&Pendulum {})? + 0.1_f64.cos();
/// assert!((now - left).abs() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Watch<'t, T: Divisible<N> + ?Sized, G, const N: usize, const K: usize> {
    dense: Dense<'t, T, N>,
    g: G,
    crossings: [Crossing; K],
    terminal: [bool; K],
    /// How the run stops at a terminal event, where it can.
    stop: Option<Stop<'t, T, N>>,
    /// When the watch ends, and how the run takes its steps to there.
    until: Option<(f64, NextUntil<'t, T, N>)>,
    /// The values at the end of the last step; `None` before the first.
    present: Option<[T::Scalar; K]>,
    /// The values at its start, and when that was.
    earlier: Option<(f64, [T::Scalar; K])>,
    /// The velocity at its end, where it was asked for.
    velocity: Option<SVector<T::Scalar, N>>,
    /// Of functions that rest at 0 a value from before; 0 of others.
    rested: [f64; K],
    /// Which events happened at the present state.
    happened: [bool; K],
    /// On which side of 0 their functions were before, where they are passed: 1 or −1, else 0.
    came_from: [f64; K],
    /// By how much their values at the start of the run are off 0 that count as 0 there.
    residues: [f64; K],
    /// Events found in the last step, in order.
    found: [Option<Found<T::Scalar, N>>; ROOTS],
    /// Which of them comes next.
    next: usize,
    /// The last step, unless it was reported.
    step: Option<Step<T::Scalar, N>>,
    restarts: u32,
    ended: bool,
}

/// Leaves the grid.
type Stop<'t, T, const N: usize> = fn(&mut Dense<'t, T, N>, f64, State<<T as Run<N>>::Scalar, N>);

/// [`Stop`] of a run that can leave its grid.
fn leave<T: Restartable<N>, const N: usize>(
    dense: &mut Dense<'_, T, N>,
    time: f64,
    state: State<T::Scalar, N>,
) {
    dense.restart_at(time, state);
}

/// Takes a step, no further than a time.
type NextUntil<'t, T, const N: usize> =
    fn(&mut Dense<'t, T, N>, f64) -> Option<Result<Step<<T as Run<N>>::Scalar, N>, StepError>>;

/// An item of a run that is watched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Watched<S, const N: usize> {
    /// An event of the step that follows.
    Event(Event<S, N>),
    /// A step of the run.
    Step(Step<S, N>),
}

impl<'t, T, G, const N: usize, const K: usize> Watch<'t, T, G, N, K>
where
    T: Divisible<N> + ?Sized,
    G: Fn(&Moment<'_, T::System, N>) -> [T::Scalar; K],
{
    /// Watches `run`, of whatever type, for the events that the functions `g` vanish.
    pub fn new(run: &'t mut T, g: G) -> Self {
        Self {
            dense: Dense::new(run),
            g,
            crossings: [Crossing::Either; K],
            terminal: [false; K],
            stop: None,
            until: None,
            present: None,
            earlier: None,
            velocity: None,
            rested: [0.0; K],
            happened: [false; K],
            came_from: [0.0; K],
            residues: [0.0; K],
            found: [None; ROOTS],
            next: 0,
            step: None,
            restarts: 0,
            ended: false,
        }
    }

    /// Counts of each function the events of one direction only.
    #[must_use]
    pub fn crossing(self, crossings: [Crossing; K]) -> Self {
        Self { crossings, ..self }
    }

    /// The run. Where events of its last step have not been asked for yet, it is ahead of them.
    #[must_use]
    pub fn run(&self) -> &T {
        self.dense.run()
    }

    /// The next item, at most a step further: its events, and then the step itself. `None` where the run has
    /// ended, by a terminal event for instance.
    ///
    /// # Errors
    /// [`EventError`], after which the watch has ended.
    #[inline]
    pub fn advance(&mut self) -> Option<Result<Watched<T::Scalar, N>, EventError>> {
        if self.has_found() {
            return self.advance_to_found();
        }
        if let Some(step) = self.step.take() {
            return Some(Ok(Watched::Step(step)));
        }
        match self.take_or_end()? {
            Ok(Some(step)) => Some(Ok(Watched::Step(step))),
            Ok(None) => self.advance_to_found(),
            Err(error) => Some(Err(error)),
        }
    }

    /// Goes on from `state` where `go_on` takes the run, at its present time.
    fn restart_by(&mut self, state: State<T::Scalar, N>, go_on: impl FnOnce(&mut Dense<'t, T, N>, f64)) {
        let time = self.run().time();
        if self.ended {
            self.found.iter_mut().flatten().for_each(|found| (found.time, found.state) = (time, state));
        } else {
            (self.happened, self.came_from) = ([false; K], [0.0; K]);
            self.found = [None; ROOTS];
        }
        go_on(&mut self.dense, time);
        (self.present, self.earlier, self.velocity) = (None, None, None);
        (self.step, self.ended) = (None, false);
        self.restarts = self.restarts.saturating_add(1);
    }

    /// Takes a step, unless the watch has ended; ends it where there is none.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn take_or_end(&mut self) -> Option<Result<Option<Step<T::Scalar, N>>, EventError>> {
        if self.ended {
            return None;
        }
        let time = self.dense.run().time();
        let taken = self.take();
        self.ended = taken.is_none();
        taken.map(|taken| taken.map_err(|error| self.refuse(error, time)))
    }

    /// Ends the watch with `error`; a step from `time` that cannot be watched is not taken, where the run can
    /// go back.
    #[cold]
    pub(super) fn refuse(&mut self, mut error: EventError, time: f64) -> EventError {
        self.ended = true;
        // What was found of other functions before the error was met.
        (self.found, self.step) = ([None; ROOTS], None);
        if let (Some(stop), Some(&Start { time: from, state, .. })) = (self.stop, self.dense.start())
            && from == time
            && self.dense.run().time() != time
        {
            stop(&mut self.dense, from, state);
        }
        if let EventError::Chattering { stands, .. } = &mut error {
            *stands = self.dense.run().time();
        }
        error
    }

    /// Takes a step, and keeps it beside its events until it is reported; `None` where the run has ended.
    pub(super) fn look(&mut self) -> Option<Result<Step<T::Scalar, N>, EventError>> {
        match self.take_or_end()? {
            Ok(taken) => {
                self.step = taken.or(self.step);
                self.step.map(Ok)
            }
            Err(error) => Some(Err(error)),
        }
    }

    /// The time of the next event of the step that was taken, and whether it ends the run.
    pub(super) fn pending(&self) -> Option<(f64, bool)> {
        let found = self.found.get(self.next)?.as_ref()?;
        Some((found.time, self.terminal.get(found.index).copied().unwrap_or(false)))
    }

    /// Takes the step that was kept beside its events.
    pub(super) fn take_kept(&mut self) -> Option<Step<T::Scalar, N>> {
        self.step.take()
    }

    /// The run as it can be looked into, with its last step.
    #[must_use]
    pub fn dense(&self) -> &Dense<'t, T, N> {
        &self.dense
    }

    #[cold]
    #[inline(never)]
    fn advance_to_found(&mut self) -> Option<Result<Watched<T::Scalar, N>, EventError>> {
        self.advance_to_event().map(|event| event.map(Watched::Event))
    }

    /// The next event of the step that was taken.
    pub(super) fn advance_to_event(&mut self) -> Option<Result<Event<T::Scalar, N>, EventError>> {
        let found = self.found.get(self.next).copied().flatten()?;
        Some(self.report(&found))
    }

    /// Whether events of the last step wait to be reported.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn has_found(&self) -> bool {
        matches!(self.found.get(self.next), Some(Some(_)))
    }

    /// Takes a step: the step itself where it is clear of events, as it is by far the most often. Where it
    /// has some, it is kept until they are reported.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn take(&mut self) -> Option<Result<Option<Step<T::Scalar, N>>, EventError>> {
        let before = match self.present {
            Some(before) => before,
            None => match self.begin() {
                Ok(before) => before,
                Err(error) => return Some(Err(error)),
            },
        };
        let next = match self.until {
            Some((until, next)) => next(&mut self.dense, until),
            None => self.dense.next(),
        };
        let step = match next? {
            Ok(step) => step,
            Err(error) => return Some(Err(error.into())),
        };
        let start = self.dense.start()?;
        let (time, state) = (self.dense.run().time(), self.dense.run().state());
        let times = [time, self.dense.since()];
        let lebesgue = Nodes::of(self.dense.nodes()).lebesgue;
        let mut range = Range::of(before);
        let mut ends = [nalgebra::zero(); 2];
        let mut velocity = None;
        let earlier = self.earlier;
        if !self.dense.is_collocated() {
            if let Some((_, earlier)) = &earlier {
                let after = (self.g)(&Moment::of(self.dense.system(), times, state, None));
                range.widen(earlier);
                range.widen(&after);
                self.dense.at_chord(start, |at| range.widen(&(self.g)(at)));
                if range.is_clear(BY_CHORD * (lebesgue + 1.0)) {
                    (self.earlier, self.present, self.velocity) =
                        (Some((start.time, before)), Some(after), None);
                    self.restarts = 0;
                    return Some(Ok(Some(step)));
                }
            }
            let found = match self.velocity {
                Some(before) => self.dense.velocity(time, state).map(|after| [before, after]),
                None => self
                    .dense
                    .velocity(start.time, &start.state)
                    .and_then(|before| self.dense.velocity(time, state).map(|after| [before, after])),
            };
            ends = match found {
                Ok(ends) => ends,
                Err(error) => return Some(Err(error.into())),
            };
            velocity = Some(ends[1]);
            if let Some((time, earlier)) = &earlier {
                range = Range::of(before);
                range.widen(earlier);
                let beyond = (self.g)(&self.dense.on_cubic(start, &ends, *time));
                range.widen(&missed(earlier, beyond));
            }
        }
        let after = (self.g)(&Moment::of(self.dense.system(), times, state, velocity));
        (self.earlier, self.present, self.velocity) = (Some((start.time, before)), Some(after), velocity);
        range.widen(&after);
        self.dense.at_nodes(start, &ends, |_, at| range.widen(&(self.g)(at)));
        // By more than a polynomial can leave the range of its values, and half a range besides. How the
        // velocity changes within a step the cubic does not see, as the step before does.
        let away = if self.dense.is_collocated() { lebesgue + 1.0 } else { BY_CUBIC };
        if (earlier.is_some() || self.dense.is_collocated()) && range.is_clear(away) {
            if self.restarts > 0 {
                self.restarts = 0;
            }
            return Some(Ok(Some(step)));
        }
        match self.locate(earlier.as_ref(), &before, &after, &ends) {
            Ok(true) => Some(Ok(Some(step))),
            Ok(false) => {
                self.step = Some(step);
                Some(Ok(None))
            }
            Err(error) => Some(Err(error)),
        }
    }

    /// Reports an event that was found, and ends the run there if it is terminal.
    fn report(&mut self, found: &Found<T::Scalar, N>) -> Result<Event<T::Scalar, N>, EventError> {
        self.next += 1;
        let velocity = self.dense.velocity(found.time, &found.state)?;
        let event = found.event(velocity, self.dense.since());
        if self.ended {
            // At the same time as a terminal one.
            self.mark(found);
        } else if let Some(stop) = self.stop
            && self.terminal.get(found.index).copied().unwrap_or(false)
        {
            let is_here = self.restarts > 0 && self.dense.run().time() == found.time;
            stop(&mut self.dense, found.time, found.state);
            self.ended = true;
            (self.step, self.present) = (None, None);
            if !is_here {
                (self.happened, self.came_from) = ([false; K], [0.0; K]);
            }
            self.mark(found);
            let size = found.elapsed.widen().abs().max(self.dense.run().step_size().widen().abs());
            let width = 64.0 * T::Scalar::EPSILON.widen() * size;
            let later = |other: &Found<T::Scalar, N>| (other.elapsed - found.elapsed).widen().abs() > width;
            for place in self.found.iter_mut().skip(self.next) {
                if place.as_ref().is_some_and(later) {
                    *place = None;
                }
            }
        }
        Ok(event)
    }

    fn mark(&mut self, found: &Found<T::Scalar, N>) {
        let (happened, side) = (self.happened.get_mut(found.index), self.came_from.get_mut(found.index));
        if let (Some(happened), Some(side)) = (happened, side) {
            *happened = true;
            *side = match found.passage {
                Passage::Rising => -1.0,
                Passage::Falling => 1.0,
                Passage::Touching => 0.0,
            };
        }
    }
}

impl<'t, T, G, const N: usize, const K: usize> Watch<'t, T, G, N, K>
where
    T: Restartable<N>,
    G: Fn(&Moment<'_, T::System, N>) -> [T::Scalar; K],
{
    /// Which events end the run.
    #[must_use]
    pub fn terminal(self, terminal: [bool; K]) -> Self {
        Self { terminal, stop: Some(leave), ..self }
    }

    /// Ends at this time, where the run then stands, its last step being as long as it takes:
    /// [`Until`](crate::run::between::Until). An event at that time belongs to this watch.
    #[must_use]
    pub fn until(self, time: f64) -> Self {
        let next: NextUntil<'t, T, N> = |dense, time| dense.next_until(time);
        Self { until: Some((time, next)), stop: Some(leave), ..self }
    }

    /// Goes on from another state at the present time of the run, that of a terminal event: an impact, a
    /// switch. Events that happened there do not happen again at once; others at that time that have not been
    /// asked for come next, and of this state.
    pub fn restart(&mut self, state: State<T::Scalar, N>) {
        self.restart_by(state, |dense, time| dense.restart_at(time, state));
    }
}

impl<'t, 'a, L, M, G, const N: usize, const K: usize> Watch<'t, Trajectory<'a, L, M, N>, G, N, K>
where
    L: Flow<M, N>,
    G: Fn(&Moment<'_, L, N>) -> [L::Scalar; K],
{
    /// As [`restart`](Self::restart), by another system of the same type
    /// ([`Trajectory::restart_with`]), which the functions are then asked of.
    pub fn restart_with(&mut self, system: &'a L, state: State<L::Scalar, N>) {
        self.restart_by(state, |dense, _| dense.restart_with(system, state));
    }
}

impl<T, G, const N: usize, const K: usize> Iterator for Watch<'_, T, G, N, K>
where
    T: Divisible<N> + ?Sized,
    G: Fn(&Moment<'_, T::System, N>) -> [T::Scalar; K],
{
    type Item = Result<Event<T::Scalar, N>, EventError>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        loop {
            match self.advance()? {
                Ok(Watched::Step(_)) => {}
                Ok(Watched::Event(event)) => return Some(Ok(event)),
                Err(error) => return Some(Err(error)),
            }
        }
    }
}
