//! Runs of steps.

use crate::numbers::Scalar;
use crate::rules::steps_until;
use crate::run::checkpoint::Toward;
use crate::run::pace::Pace;
use crate::run::present::at_present;
use crate::run::{Checkpoint, Course, DrivenTrajectory, Run, Samples, TakenUntil};
use crate::step::{Discretised, Flow, Memory, State, Step, StepError};

/// Runs.
impl<'a, L, M, const N: usize> Discretised<'a, L, M, N>
where
    L: Flow<M, N>,
{
    /// The steps from `state`, one after the other: each is cheaper than [`step`](Self::step), by what is
    /// known of those before. The first starts from the velocity of [`near`](Self::near), where one was
    /// given.
    #[must_use = "a run is an iterator: it takes a step when it is asked for the next"]
    pub fn run(&self, state: State<L::Scalar, N>) -> Trajectory<'a, L, M, N> {
        Trajectory { system: self.system, run: self.run_with_inputs(state), pace: None }
    }
}

/// The trajectory of a system from a state, one step at a time: by a rule, a
/// [`Composition`](crate::Composition) or a [`Splitting`](crate::Splitting).
///
/// An iterator over steps; it holds the present state and what the method remembers of the steps before
/// ([`Memory`]). After an error it ends, its state being the last good one; another step size
/// ([`Trajectory::change_step_size`]) lets it go on.
///
/// **Time.** Where L, R or f take the time, each step sees its own: the time of the system given,
/// `system.at_time(t)`, and what the trajectory has taken since. The view given stands still meanwhile: asked
/// through it, a later state has the velocity and the energy of another system. [`velocity`](Self::velocity),
/// [`energy`](Self::energy) and [`at_present`](Self::at_present) ask at the present time,
/// [`ledger`](Self::ledger) accounts for each step at its own, and a [`Sample`](crate::run::Sample) knows its
/// time. A rocket with gas that leaves it with 4000:
///
/// ```
/// use dalembert::{Discretise, Gauss, State, rayleigh_system};
///
/// struct Rocket;
///
/// #[rayleigh_system(rule = gauss)]
/// impl Rocket {
///     fn lagrangian(&self, _q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
///         0.5 * (100.0 - 0.5 * t) * v[0] * v[0]
///     }
///     fn force(&self, _q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
///         [0.5 * (4000.0 - v[0])]
///     }
/// }
///
/// let start = Rocket.at_time(0.0);
/// let mut run = start.by(Gauss::<3>, 0.5).run(State { q: [0.0].into(), p: [0.0].into() });
/// run.by_ref().take(320).for_each(|step| assert!(step.is_ok()));
/// // 80 of 100 are burnt.
/// let by_hand = 4000.0 * 5.0_f64.ln();
/// assert!((run.velocity()?[0] / by_hand - 1.0).abs() < 1e-10);
/// // The rocket as it was at the start would go at a fifth of that.
/// assert!((run.state().velocity(&start)?[0] / by_hand - 0.2).abs() < 1e-10);
/// // A of the step that comes next.
/// let state = *run.state();
/// let (_, next) = run.at_present(|rocket| rocket.by(Gauss::<3>, 0.5).linearized_step(&state))?;
/// assert!((next.q_by_p[0] / (0.5 / 20.0) - 1.0).abs() < 1e-9);
/// # Ok::<(), dalembert::StepError>(())
/// ```
pub struct Trajectory<'a, L, M, const N: usize>
where
    L: Flow<M, N>,
{
    pub(super) system: &'a L,
    pub(super) run: DrivenTrajectory<L, M, N>,
    /// How steps follow a time scale, if they do.
    pub(super) pace: Option<Pace<L, M, N>>,
}

impl<'a, L, M, const N: usize> Trajectory<'a, L, M, N>
where
    L: Flow<M, N>,
{
    /// The present state: that of the last step that succeeded.
    pub fn state(&self) -> &State<L::Scalar, N> {
        self.run.state()
    }

    /// The step size h, of the last step where steps follow the motion.
    pub fn step_size(&self) -> L::Scalar {
        self.run.step_size()
    }

    /// The time, h × the number of steps taken (and what earlier step sizes took): no sum of roundings.
    pub fn time(&self) -> f64 {
        self.run.time()
    }

    at_present!(run => run.system, 0.0);

    /// Goes on with another step size from the present state, also after an error. Where steps follow the
    /// motion it is Δτ.
    pub fn change_step_size(&mut self, h: L::Scalar) {
        self.run.change_step_size(h);
        if let Some(pace) = &mut self.pace {
            pace.begin(h);
        }
    }

    /// Goes on from another state at the present time, after an impact for instance: what the method
    /// remembers is forgotten. The steps that follow are counted from here.
    ///
    /// ```
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn pendulum(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] + q[0].cos()
    /// }
    /// let mut run = Pendulum {}.by(Midpoint, 0.1).run(State::from_velocity(&Pendulum {}, [1.0], [0.0])?);
    /// let state = run.nth(9).unwrap()?.state;
    /// run.restart(State { q: state.q, p: -state.p });
    /// let back = run.nth(9).unwrap()?.state;
    /// // The midpoint rule undoes its steps.
    /// assert!((back.q[0] - 1.0).abs() < 1e-14 && run.time() == 2.0);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    pub fn restart(&mut self, state: State<L::Scalar, N>) {
        self.restart_at(self.time(), state);
    }

    /// Goes on by another system of the same type, which has other fields, from `state` at the present time:
    /// a switch, a contact, a cut-off. As after [`restart`](Self::restart) the steps that follow are counted
    /// from here, by the step size of the run.
    ///
    /// The clock goes on. A view that has a time has it at the time 0 of the run, as the first one:
    /// `system.at_time(t)` with the t that the run began with.
    ///
    /// ```
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn cart(q: [f64; 1], v: [f64; 1], pull: f64) -> f64 {
    ///     0.5 * v[0] * v[0] + pull * q[0]
    /// }
    /// let (on, off) = (Cart { pull: 2.0 }, Cart { pull: 0.0 });
    /// let mut run = on.by(Midpoint, 0.25).run(State::from_velocity(&on, [0.0], [0.0])?);
    /// // The motor is cut off at a velocity of 3, t = 1.5.
    /// let event = run.watch(|at| [at.velocity()[0] - 3.0]).terminal([true]).next().unwrap()?;
    /// run.restart_with(&off, event.state);
    /// run.until(2.0).try_for_each(|step| step.map(drop))?;
    /// assert!((run.state().q[0] - (0.5 * 2.0 * 1.5 * 1.5 + 3.0 * 0.5)).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn restart_with(&mut self, system: &'a L, state: State<L::Scalar, N>) {
        self.system = system;
        self.restart(state);
    }

    /// A run of another system, of whatever type and number of coordinates, that goes on from `state` at the
    /// present time by the method and the step size of this one: the next phase, in which a constraint holds
    /// a coordinate, or there is one less. This run stays where it is, so that a later phase may
    /// [restart](Self::restart_at) it. The guide has
    /// [programs](crate::guide::control#phases).
    ///
    /// The clock goes on, as in [`restart_with`](Self::restart_with). Where steps follow a time scale, the
    /// new run begins with steps of one size, the last one's.
    pub fn handed_to<'b, T, const K: usize>(
        &self,
        system: &'b T,
        state: State<T::Scalar, K>,
    ) -> Trajectory<'b, T, M, K>
    where
        T: Flow<M, K, Scalar = L::Scalar>,
    {
        Trajectory { system, run: self.run.handed_to(state), pace: None }
    }

    /// Goes on from another state at another time: after a motion has rested for a while, for instance.
    pub fn restart_at(&mut self, time: f64, state: State<L::Scalar, N>) {
        self.run.restart_at(time, state);
        if let Some(pace) = &mut self.pace {
            pace.begin_again();
        }
    }

    /// All that is needed to go on from here, in this process or another ([`Trajectory::resume`]).
    ///
    /// The run forgets what its method remembers of earlier steps, as one that is resumed has to: both go on
    /// bit by bit alike. A rule that adds up with compensation ([`Gauss`](crate::Gauss)) loses the rest
    /// at this one place, less than the last digit.
    pub fn checkpoint(&mut self) -> Checkpoint<L::Scalar, N> {
        if let Some(pace) = &mut self.pace {
            pace.forget();
        }
        self.run.checkpoint()
    }

    /// The run that `checkpoint` was taken of.
    ///
    /// A checkpoint that no run can have left is refused by the first step: with a [`StepError`] that says
    /// whether its step size, its state or its time is at fault.
    ///
    /// ```
    /// use dalembert::{Discretise, Midpoint, State, Trajectory, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn pendulum(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] + q[0].cos()
    /// }
    /// let start = State::from_velocity(&Pendulum {}, [1.0], [0.0])?;
    /// let mut run = Pendulum {}.by(Midpoint, 0.1).run(start);
    /// run.by_ref().take(100).for_each(|step| assert!(step.is_ok()));
    /// let mut resumed = Trajectory::resume(&Pendulum {}, Midpoint, run.checkpoint());
    /// for _ in 0..100 {
    ///     assert_eq!(run.next(), resumed.next());
    /// }
    /// assert_eq!(run.time(), resumed.time());
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    pub fn resume(system: &'a L, method: M, checkpoint: Checkpoint<L::Scalar, N>) -> Self {
        let _ = method;
        Self::from_checkpoint(system, checkpoint)
    }

    pub(crate) fn from_checkpoint(system: &'a L, checkpoint: Checkpoint<L::Scalar, N>) -> Self {
        Self { system, run: DrivenTrajectory::resume(checkpoint), pace: None }
    }

    /// Takes a step that was prepared.
    #[inline]
    fn take(&mut self, size: L::Scalar) -> Result<Step<L::Scalar, N>, StepError> {
        let DrivenTrajectory { at, memory, .. } = &mut self.run;
        let step = memory.0.advance_later(self.system, at.time(), &at.state, size);
        match &step {
            Ok(step) => at.follow(&step.state),
            Err(_) => self.end(),
        }
        step
    }

    /// The next step on the way to `end`, with its size.
    pub(super) fn next_until(&mut self, end: f64) -> Option<TakenUntil<L::Scalar, N>> {
        if self.run.at.toward(end) == Toward::Nowhere {
            self.run.at.settle(end);
            return None;
        }
        if self.run.course != Course::Open
            && let Some(stop) = self.stop()
        {
            return stop.map(Err);
        }
        // Where steps follow the motion, the size is known now.
        let own = self.run.at.step_size;
        let Toward::Last(size) = self.run.at.toward(end) else {
            return Some(self.take(own).map(|step| (step, own)));
        };
        let step = match self.take(size) {
            Ok(step) => step,
            Err(error) => return Some(Err(error)),
        };
        self.run.at.arrive(end);
        match &mut self.pace {
            None => self.run.course = self.run.course.moved(&self.run.at),
            // Steps that follow the motion are prepared, each of them.
            Some(pace) if size != own => pace.begin_again(),
            Some(_) => {}
        }
        Some(Ok((step, size)))
    }

    /// The reason not to take the next step: `Some(None)` at the end of the run or, once, `Some` of an error.
    #[cold]
    #[inline(never)]
    fn stop(&mut self) -> Option<Option<StepError>> {
        if self.run.course == Course::Ended {
            return Some(None);
        }
        let error = self.prepare().err()?;
        self.run.course = Course::Ended;
        Some(Some(error))
    }

    /// Makes sure of the next step, and of its size where it follows the motion.
    #[cold]
    #[inline(never)]
    pub(super) fn prepare(&mut self) -> Result<(), StepError> {
        if let Some(pace) = &mut self.pace {
            pace.next(self.system, &mut self.run)?;
        }
        if let Err(error) = self.run.require_step(self.system) {
            self.take_back();
            return Err(error);
        }
        if self.pace.is_some() && self.run.course == Course::Open {
            self.run.course = Course::Watched;
        }
        Ok(())
    }

    /// After a step that was prepared and not taken.
    #[cold]
    fn take_back(&mut self) {
        if let Some(pace) = &mut self.pace {
            pace.undo(&mut self.run.at);
        }
    }

    /// Ends the run at a step that was prepared and failed.
    #[cold]
    pub(super) fn end(&mut self) {
        self.take_back();
        self.run.course = Course::Ended;
    }

    /// Every `stride`-th step only, with what the steps between reported: long runs in constant memory.
    ///
    /// A stride of 0 counts as 1. An error on any step is returned at once.
    pub fn sample_every(&mut self, stride: u64) -> Samples<'_, Self, N> {
        Samples::new(self, stride)
    }
}

impl<L, M, const N: usize> Iterator for Trajectory<'_, L, M, N>
where
    L: Flow<M, N>,
{
    type Item = Result<Step<L::Scalar, N>, StepError>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        if self.run.course != Course::Open
            && let Some(stop) = self.stop()
        {
            return stop.map(Err);
        }
        Some(self.take(self.run.at.step_size))
    }
}

impl<L, M, const N: usize> Trajectory<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// Solves the stages of a [`Gauss`](crate::Gauss) rule no further than an error of `error`, in units of
    /// q, at the time `time` asks for; other methods solve to rounding as ever. What a step's sweeps leave
    /// unsolved is held below
    ///
    /// ```text
    /// |δq| ≤ ε/(100 n),   w |δp| ≤ ε/(100 n)        ε the error, n the steps from here to `time`
    /// w = max |Δq|/max |Δp|, over the steps so far and all coordinates
    /// ```
    ///
    /// so that all steps together move the end by at most ε/100, times what the motion makes of an early
    /// error: as much as of the method's own error in its steps. At large errors and long steps that halves
    /// the sweeps.
    ///
    /// **It costs structure.** The energy errs by about ε/100 with time, as no symplectic step makes it;
    /// momentum maps are kept to the same. So it is for an end and an error, not for long runs: steps after
    /// `time` are solved to rounding again, as are the first step and those that Newton's method has to
    /// solve. [`to_error`](crate::Discretise::to_error) chooses the step size, too, does the same, and its
    /// guard sees what is left.
    ///
    /// The [`Report`](crate::step::Report) of a step solved so has for `residual` what is left of the
    /// momenta, and for `floor` what might be. A [`checkpoint`](Self::checkpoint) ends it.
    ///
    /// Other values of such a step are those of its stages as they were left: the state between its ends
    /// ([`between`](crate::run::between)), and derivatives that take the stages from the memory of the run
    /// ([`Linearizable::linearized`](crate::step::Linearizable::linearized)), off by about what is left times
    /// the second derivatives. [`Discretised::linearized_step`] solves the stages to rounding first.
    ///
    /// ```
    /// use dalembert::{Discretise, Gauss, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = gauss)]
    /// fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
    /// }
    /// let system = Pendulum { r: 0.01 };
    /// let start = State::from_velocity(&system, [1.0], [0.0])?;
    /// let end = |run: &mut dyn Iterator<Item = Result<dalembert::step::Step<f64, 1>, _>>| run.nth(39).unwrap();
    /// let method = system.by(Gauss::<6>, 0.5);
    /// let (solved, loose) = (end(&mut method.run(start))?, end(&mut method.run(start).solved_for(1e-6, 20.0))?);
    /// assert!((solved.state.q - loose.state.q).amax() < 1e-8);
    /// assert!(loose.report.iterations < solved.report.iterations);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    #[must_use = "the run given is consumed"]
    pub fn solved_for(mut self, error: f64, time: f64) -> Self {
        let steps = steps_until(time - self.time(), self.step_size().widen());
        self.run.memory.0.leave_unsolved(error, steps);
        self
    }
}

impl<L: Flow<M, N>, M, const N: usize> Run<N> for Trajectory<'_, L, M, N> {
    type Scalar = L::Scalar;

    fn state(&self) -> &State<L::Scalar, N> {
        self.state()
    }

    fn time(&self) -> f64 {
        self.time()
    }
}
