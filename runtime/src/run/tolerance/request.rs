//! A tolerance for a system, by the methods that it offers.

use core::fmt;

use super::grid::{Bounds, Breaks};
use super::reached::{Followed, HOPELESS, Reached, reached};
use super::{Choice, GuardedTrajectory, Methods, ToleranceError, bounded};
use crate::step::stop::Stop;
use crate::step::{State, StepError};
use crate::system::ActingForce;

/// A tolerance for a system: [`to_error`](crate::Discretise::to_error).
#[must_use = "nothing is chosen before `until`"]
pub struct Request<'a, L, M> {
    system: &'a L,
    methods: M,
    tolerance: f64,
}

/// A tolerance for a system over a time: [`Request::until`].
#[must_use = "nothing is chosen before `choice` or `run`"]
pub struct TimedRequest<'a, L, M> {
    request: Request<'a, L, M>,
    time: f64,
    bounds: Bounds<'a>,
}

// By hand: derived, they would ask for a system that is copied.
impl<L, M: Copy> Clone for Request<'_, L, M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L, M: Copy> Copy for Request<'_, L, M> {}

impl<L, M: Copy> Clone for TimedRequest<'_, L, M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<L, M: Copy> Copy for TimedRequest<'_, L, M> {}

impl<L, M> fmt::Debug for Request<'_, L, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Request").field("tolerance", &self.tolerance).finish_non_exhaustive()
    }
}

impl<L, M> fmt::Debug for TimedRequest<'_, L, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { request, time, bounds } = self;
        let mut shown = f.debug_struct("TimedRequest");
        shown.field("tolerance", &request.tolerance).field("time", time).field("bounds", bounds);
        shown.finish_non_exhaustive()
    }
}

impl<'a, L, M> Request<'a, L, M> {
    pub(crate) fn new(system: &'a L, methods: M, tolerance: f64) -> Self {
        Self { system, methods, tolerance }
    }

    /// Of these methods alone.
    pub fn among<W>(self, methods: W) -> Request<'a, L, W> {
        Request { system: self.system, methods, tolerance: self.tolerance }
    }

    /// Over the time `time`.
    pub fn until(self, time: f64) -> TimedRequest<'a, L, M> {
        TimedRequest { request: self, time, bounds: Bounds::default() }
    }
}

impl<'a, L, M> TimedRequest<'a, L, M> {
    /// In no more than so many steps, 10⁷ unless said: more are [`ToleranceError::TooManySteps`], which
    /// says how long a step would be needed. It is told before the run, so that no call goes on for ever; of
    /// [`end`](Self::end) the steps of all runs count together.
    pub fn at_most(mut self, steps: u64) -> Self {
        self.bounds.most = steps;
        self
    }

    /// At a cost of no more than so many evaluations of the forces, as [`Trial`](super::Trial) counts them:
    /// there is no limit unless one is said. A run that is expected to cost more is
    /// [`ToleranceError::TooManyEvaluations`], told before it; of [`end`](Self::end) all runs count together,
    /// with their guards.
    pub fn at_most_evaluations(mut self, evaluations: f64) -> Self {
        self.bounds.costliest = evaluations;
        self
    }

    /// By steps no longer than `step_size`, each of them looked into.
    ///
    /// Choice and guard look at the system at the nodes of steps, and at the force in the middle of each.
    /// Where something happens between them and is over by then, as a short pulse of force, they cannot see
    /// it: a step of a third of its length sees it.
    pub fn longest_step(mut self, step_size: f64) -> Self {
        self.bounds.longest = step_size;
        self
    }

    /// With these times as ends of steps: those at which the force or another function of the system jumps,
    /// or its slope does. Times outside the run are left out; the order does not matter.
    ///
    /// A step over a jump errs by its size times h, whatever the method's order. So steps end there, and the
    /// next ones, of a size of their own, start on the other side; the choice looks at each side, and so does
    /// the guard.
    ///
    /// ```
    /// use dalembert::{Discretise, State, rayleigh_system};
    ///
    /// struct Pushed;
    /// #[rayleigh_system(rule = [trapezoidal, gauss])]
    /// impl Pushed {
    ///     fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
    ///         0.5 * v[0] * v[0]
    ///     }
    ///     fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
    ///         [if t > 4.0 && t < 4.1 { 10.0 } else { 0.0 }]
    ///     }
    /// }
    /// let system = Pushed.at_time(0.0);
    /// let start = State::from_velocity(&system, [0.0], [0.0])?;
    /// let reached = system.to_error(1e-9).until(10.0).breaking_at([4.0, 4.1]).end(&start)?;
    /// // A velocity of 1, from the middle of the push on.
    /// assert!((reached.state.q[0] - (10.0 - 4.05)).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn breaking_at<const K: usize>(mut self, times: [f64; K]) -> Self {
        self.bounds.breaks = Breaks::new(times);
        self
    }

    /// Ends with [`ToleranceError::Stopped`] as soon as `stop` says so: the choice after two steps, the
    /// runs of [`end`](Self::end) after [`Stop::STRIDE`]. A run that is handed out ([`run`](Self::run),
    /// [`Choice::trajectory`]) is in the caller's hands.
    pub fn stopped_by(mut self, stop: Stop<'a>) -> Self {
        self.bounds.stop = stop;
        self
    }

    /// The method and step size for the motion from `start`, with the reasons.
    ///
    /// # Errors
    /// A [`ToleranceError`].
    pub fn choice<const N: usize>(
        self,
        start: &State<L::Scalar, N>,
    ) -> Result<Choice<'a, L, M, N>, ToleranceError>
    where
        L: ActingForce<N>,
        M: Methods<L, N>,
    {
        let Request { system, methods, tolerance } = self.request;
        bounded((system, methods), start, [self.time, tolerance], self.bounds)
    }

    /// The run from `start` by the method and step size chosen for it, with its guard.
    ///
    /// # Errors
    /// A [`ToleranceError`].
    pub fn run<const N: usize>(
        self,
        start: State<L::Scalar, N>,
    ) -> Result<GuardedTrajectory<'a, L, M, N>, ToleranceError>
    where
        L: ActingForce<N>,
        M: Methods<L, N>,
    {
        self.choice(&start).map(|choice| choice.trajectory())
    }

    /// The end of a run whose error is kept on the whole way, as far as its guard can tell.
    ///
    /// The first steps do not always show what comes: a run that starts at the apocentre of a long ellipse
    /// passes its error at the pericentre. So as long as a run ends in a breach, or a step of it fails,
    /// another one starts from the beginning. Its method and step size are chosen where the last one erred
    /// most as well as at the start, for an error that is smaller by as much as errors have grown on the way;
    /// where no method is expected to reach that, the last one takes shorter steps. What is kept is the
    /// tolerance. Most motions need one run or two; eight are tried. The page
    /// `docs/evidence/tolerance.md` counts how often none of them keeps it: at kinks, as a rule.
    ///
    /// ```
    /// use dalembert::{Discretise, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = [trapezoidal, gauss])]
    /// fn kepler(q: [f64; 2], v: [f64; 2]) -> f64 {
    ///     0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
    /// }
    ///
    /// // From the apocentre of an ellipse with e = 0.8, once around.
    /// let start = State::from_velocity(&Kepler {}, [-1.8, 0.0], [0.0, -1.0 / 3.0])?;
    /// let period = std::f64::consts::TAU;
    /// let reached = Kepler {}.to_error(1e-9).until(period).end(&start)?;
    /// assert!((reached.state.q - start.q).amax() < 1e-9);
    /// println!("{} runs, the last by {}", reached.runs, reached.choice);
    /// // The same run, to be sampled.
    /// assert_eq!(reached.choice.trajectory().last().unwrap()?.state, reached.state);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ToleranceError::Breach`] or [`ToleranceError::Step`] of the last run where none keeps the error;
    /// others where no method is chosen to begin with.
    pub fn end<const N: usize>(
        self,
        start: &State<L::Scalar, N>,
    ) -> Result<Reached<'a, L, M, N>, ToleranceError>
    where
        L: ActingForce<N>,
        M: Methods<L, N>,
    {
        let stop = self.bounds.stop;
        self.end_followed(start, |run| {
            // A run that is stopped says nothing, whatever it is handed on as.
            while !stop.is_asked() {
                for _ in 0..Stop::STRIDE {
                    match run.next() {
                        Some(step) => drop(step?),
                        None => return Ok(()),
                    }
                }
            }
            Ok(())
        })
    }

    /// As [`end`](Self::end), with the steps of each run that is tried taken by `follow`: to record them, or
    /// to watch for events, anew for each. What it leaves of a run is not taken, as behind an event that ends
    /// it; the error of a step that fails it hands on. A run whose error has come to 3·10⁴ times the
    /// tolerance ends there. Where the caller may stop the request ([`stopped_by`](Self::stopped_by)),
    /// `follow` ends as well.
    ///
    /// ```
    /// use dalembert::{Discretise, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = [trapezoidal, gauss])]
    /// fn oscillator(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    /// }
    /// let start = State::from_velocity(&Oscillator {}, [1.0], [0.0])?;
    /// let mut zeros = Vec::new();
    /// let reached = Oscillator {}.to_error(1e-9).until(10.0).end_followed(&start, |run| {
    ///     zeros = run.watch(|at| [at.q[0]]).map_while(|zero| zero.ok()).map(|zero| zero.time).collect();
    ///     Ok(())
    /// })?;
    /// assert!((reached.state.q[0] - 10.0_f64.cos()).abs() < 1e-9);
    /// assert!(zeros.len() == 3 && (zeros[2] - 2.5 * std::f64::consts::PI).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`end`](Self::end).
    pub fn end_followed<const N: usize>(
        self,
        start: &State<L::Scalar, N>,
        mut follow: impl FnMut(&mut GuardedTrajectory<'a, L, M, N>) -> Result<(), StepError>,
    ) -> Result<Reached<'a, L, M, N>, ToleranceError>
    where
        L: ActingForce<N>,
        M: Methods<L, N>,
    {
        let Request { system, methods, tolerance } = self.request;
        reached((system, methods), start, [self.time, tolerance], self.bounds, &mut |choice| {
            let mut run = choice.trajectory().given_up_beyond(HOPELESS * tolerance);
            let failure = follow(&mut run).err();
            let (of_steps, of_guard) = run.evaluations();
            Followed {
                state: *run.state(),
                expected: run.expected(),
                largest: run.largest(),
                hardest: *run.hardest(),
                breach: run.breach().copied(),
                failure,
                steps: run.taken(),
                evaluations: of_steps + of_guard,
            }
        })
    }
}
