//! Events of runs by every method: when a function of the motion vanishes, to rounding, and what follows.

mod error;
mod event;
mod nodes;
mod on_step;
mod range;
mod roots;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::run::between::{Dense, Divisible, Moment, Restartable};
use crate::run::{Run, Trajectory};
use crate::step::{Flow, State, Step};
pub use error::EventError;
pub use event::{Event, EventDerivatives, EventGradient};
use nodes::Nodes;
use on_step::Found;
use range::{BY_CHORD, Range, missed};
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
/// **What is not an event.** A start on the event: a run that begins where g is 0 to rounding. A root at the
/// end of a step belongs to that step.
///
/// **The run** takes the same steps as unwatched, bit by bit, unless it ends at a
/// [`terminal`](Self::terminal) event: there it stands at the event's time and state, its memory forgotten.
/// [`restart`](Self::restart) goes on from there, from another state perhaps.
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
pub struct Watch<'t, T: Divisible<N>, G, const N: usize, const K: usize> {
    dense: Dense<'t, T, N>,
    g: G,
    crossings: [Crossing; K],
    terminal: [bool; K],
    /// How the run stops at a terminal event, where it can.
    stop: Option<Stop<'t, T, N>>,
    until: Option<f64>,
    /// The values at the end of the last step; `None` before the first.
    present: Option<[T::Scalar; K]>,
    /// The values at its start, and when that was.
    earlier: Option<(f64, [T::Scalar; K])>,
    /// The velocity at its end, where it was asked for.
    velocity: Option<SVector<T::Scalar, N>>,
    /// Which events happened at the present state.
    happened: [bool; K],
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
    T: Divisible<N>,
    G: Fn(&Moment<'_, T::System, N>) -> [T::Scalar; K],
{
    /// Watches `run`, of whatever type, for the events that the functions `g` vanish.
    pub fn new(run: &'t mut T, g: G) -> Self {
        Self {
            dense: Dense::of(run),
            g,
            crossings: [Crossing::Either; K],
            terminal: [false; K],
            stop: None,
            until: None,
            present: None,
            earlier: None,
            velocity: None,
            happened: [false; K],
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

    /// Ends the iteration over events at this time: the run takes no step from there on.
    ///
    /// The events of the last step, which was begun before this time, are all told, those after this time
    /// too: the run is past them, and another watch would not find them again.
    #[must_use]
    pub fn until(self, time: f64) -> Self {
        Self { until: Some(time), ..self }
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
        if self.ended {
            return None;
        }
        match self.take() {
            Some(Ok(Some(step))) => Some(Ok(Watched::Step(step))),
            Some(Ok(None)) => self.advance_to_found(),
            Some(Err(error)) => {
                self.ended = true;
                Some(Err(error))
            }
            None => {
                self.ended = true;
                None
            }
        }
    }

    #[cold]
    #[inline(never)]
    fn advance_to_found(&mut self) -> Option<Result<Watched<T::Scalar, N>, EventError>> {
        let found = self.found.get(self.next).copied().flatten()?;
        Some(self.report(&found).map(Watched::Event))
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
        let step = match self.dense.next()? {
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
        if (earlier.is_some() || self.dense.is_collocated()) && range.is_clear(lebesgue + 1.0) {
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
        let event = found.event(velocity);
        if self.ended {
            // At the same time as a terminal one.
            self.mark(found.index);
        } else if let Some(stop) = self.stop
            && self.terminal.get(found.index).copied().unwrap_or(false)
        {
            stop(&mut self.dense, found.time, found.state);
            self.ended = true;
            (self.step, self.present) = (None, None);
            self.happened = [false; K];
            self.mark(found.index);
            let width = 8.0 * T::Scalar::EPSILON.widen() * found.elapsed.widen().abs();
            let later = |other: &Found<T::Scalar, N>| (other.elapsed - found.elapsed).widen().abs() > width;
            for place in self.found.iter_mut().skip(self.next) {
                if place.as_ref().is_some_and(later) {
                    *place = None;
                }
            }
        }
        Ok(event)
    }

    fn mark(&mut self, index: usize) {
        if let Some(happened) = self.happened.get_mut(index) {
            *happened = true;
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
        let stop: Stop<'t, T, N> = |dense, time, state| dense.restart_at(time, state);
        Self { terminal, stop: Some(stop), ..self }
    }

    /// Goes on from another state at the present time of the run, that of a terminal event: an impact, a
    /// switch. Events that happened there do not happen again at once.
    pub fn restart(&mut self, state: State<T::Scalar, N>) {
        let time = self.run().time();
        if !self.ended {
            self.happened = [false; K];
        }
        self.dense.restart_at(time, state);
        (self.present, self.earlier, self.velocity) = (None, None, None);
        (self.step, self.ended) = (None, false);
        self.found = [None; ROOTS];
        self.restarts = self.restarts.saturating_add(1);
    }
}

impl<T, G, const N: usize, const K: usize> Iterator for Watch<'_, T, G, N, K>
where
    T: Divisible<N>,
    G: Fn(&Moment<'_, T::System, N>) -> [T::Scalar; K],
{
    type Item = Result<Event<T::Scalar, N>, EventError>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let backwards = self.run().step_size() < T::Scalar::constant(0.0);
        let is_before = |time: f64, until: f64| if backwards { time > until } else { time < until };
        loop {
            if let Some(until) = self.until
                && !self.has_found()
                && !is_before(self.run().time(), until)
            {
                return None;
            }
            match self.advance()? {
                Ok(Watched::Step(_)) => {}
                Ok(Watched::Event(event)) => return Some(Ok(event)),
                Err(error) => return Some(Err(error)),
            }
        }
    }
}
