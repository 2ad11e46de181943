//! Runs whose input changes from step to step.

use crate::run::checkpoint::Toward;
use crate::run::last_step::Remembered;
use crate::run::{Checkpoint, Course};
use crate::step::{Discretised, Flow, Linearizable, Memory, State, Step, StepError, StepTaken};

/// A step and its size.
pub(crate) type TakenUntil<S, const N: usize> = Result<(Step<S, N>, S), StepError>;

/// Runs with inputs.
impl<L, M, const N: usize> Discretised<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// A run from `state` that is given its system, with the input held over the step, anew at each step. The
    /// input held here says no more than of what kind the systems are; its type, with the lifetime of the
    /// view, does, so that a machine whose fields change under the run is better given to
    /// [`DrivenTrajectory::new`].
    pub fn run_with_inputs(&self, state: State<L::Scalar, N>) -> DrivenTrajectory<L, M, N> {
        let mut run = DrivenTrajectory::new(self.h, state);
        if let Some(velocity) = &self.guess {
            Memory::<L, M, N>::suggest(&mut run.memory.0, velocity, self.h);
        }
        run
    }
}

/// A run of steps with an input each: the model in a control loop, in an estimator or in optimal control.
///
/// It keeps what a [`Trajectory`](crate::Trajectory) keeps, the state, the clock and what the method
/// remembers of earlier steps, and borrows no system: each step is given its own, `system.driven(u)`, and so
/// may come from fields that have changed as well. Where L, R or f take the time, that is the view's,
/// `system.driven(u, t)`, at the [`time`](Self::time) of the run: for the step, and for what is asked of the
/// state after it, velocity and energy, another one at the time that is then. An error leaves the state as it
/// was, and the next call tries again.
///
/// V is the type of the views, and only says of what kind they are. That of
/// [`run_with_inputs`](Discretised::run_with_inputs) names the lifetime of the view that it was asked of, and
/// the machine stays borrowed. [`new`](Self::new) makes a run that names none: for a struct that owns its
/// machine, and wherever fields change,
///
/// ```
/// use dalembert::run::DrivenTrajectory;
/// use dalembert::{Midpoint, State, rayleigh_system};
///
/// struct Cart {
///     m: f64,
/// }
///
/// #[rayleigh_system]
/// impl Cart {
///     fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
///         0.5 * self.m * v[0] * v[0]
///     }
///     fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
///         u
///     }
/// }
///
/// struct Controller {
///     cart: Cart,
///     model: DrivenTrajectory<DrivenCart<'static>, Midpoint, 1>,
/// }
///
/// let cart = Cart { m: 2.0 };
/// let start = State::from_velocity(&cart, [0.0], [1.0])?;
/// let mut controller = Controller { cart, model: DrivenTrajectory::new(0.01, start) };
/// controller.model.advance(&controller.cart.driven([0.0]))?;
/// controller.cart.m = 3.0; // it has picked something up
/// controller.model.advance(&controller.cart.driven([0.0]))?;
/// assert!((controller.model.state().q[0] - 0.01 * (1.0 + 2.0 / 3.0)).abs() < 1e-15);
/// # Ok::<(), dalembert::StepError>(())
/// ```
///
/// ```
/// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
///
/// struct Cart {
///     m: f64,
///     c: f64,
/// }
///
/// #[rayleigh_system]
/// impl Cart {
///     fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
///         0.5 * self.m * v[0] * v[0]
///     }
///     fn rayleigh(&self, v: [f64; 1]) -> f64 {
///         0.5 * self.c * v[0] * v[0]
///     }
///     fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
///         u
///     }
/// }
///
/// let cart = Cart { m: 2.0, c: 0.1 };
/// let start = State::from_velocity(&cart, [1.0], [0.0])?;
/// let mut run = cart.driven([0.0]).by(Midpoint, 0.01).run_with_inputs(start);
/// for _ in 0..1500 {
///     let State { q, p } = run.state();
///     run.advance(&cart.driven([-2.0 * q[0] - p[0]]))?;
/// }
/// assert!(run.state().q[0].abs() < 1e-2 && (run.time() - 15.0).abs() < 1e-12);
///
/// // A step with A and B of its input; both come from one factorisation.
/// let driven = cart.driven([0.3]);
/// let taken = run.advance_linearized(&driven)?;
/// let (a, b) = (taken.by_state()?, taken.by_input::<1>()?);
/// assert!((a.p_by_p[0] - 0.9995).abs() < 1e-6 && (b.p[0] - 0.01).abs() < 1e-5);
/// # Ok::<(), dalembert::StepError>(())
/// ```
pub struct DrivenTrajectory<V, M, const N: usize>
where
    V: Flow<M, N>,
{
    pub(super) at: Checkpoint<V::Scalar, N>,
    pub(super) memory: Remembered<M, V::RunMemory>,
    pub(super) course: Course,
}

/// The copy goes on as the run itself would, bit by bit.
impl<V, M, const N: usize> Clone for DrivenTrajectory<V, M, N>
where
    V: Flow<M, N>,
    V::RunMemory: Clone,
{
    fn clone(&self) -> Self {
        Self { at: self.at, memory: self.memory.clone(), course: self.course }
    }
}

impl<V, M, const N: usize> DrivenTrajectory<V, M, N>
where
    V: Flow<M, N>,
{
    /// A run from `state` at time 0 with step size `h`.
    #[must_use]
    pub fn new(h: V::Scalar, state: State<V::Scalar, N>) -> Self {
        Self::resume(Checkpoint::new(h, state))
    }

    /// The run that `checkpoint` was taken of. One that no run can have left is refused by the first step.
    #[must_use]
    pub fn resume(checkpoint: Checkpoint<V::Scalar, N>) -> Self {
        Self { at: checkpoint, memory: Remembered::default(), course: Course::Starting }
    }

    /// The present state: that of the last step that succeeded, or the one [corrected](Self::correct).
    pub fn state(&self) -> &State<V::Scalar, N> {
        &self.at.state
    }

    /// The step size h.
    pub fn step_size(&self) -> V::Scalar {
        self.at.step_size
    }

    /// The time since the start, h × the number of steps taken (and what earlier step sizes took).
    pub fn time(&self) -> f64 {
        self.at.time()
    }

    /// Goes on with another step size from the present state.
    pub fn change_step_size(&mut self, h: V::Scalar) {
        self.at = Checkpoint { step_size: h, origin: self.time(), steps: 0, state: self.at.state };
        self.course = self.course.resized();
    }

    /// Goes on from `state`, near the present one: what an estimator makes of it by a measurement. The guess
    /// for the next step is kept. One that is far off is a new run's start.
    pub fn correct(&mut self, state: State<V::Scalar, N>) {
        self.at.state = state;
        Memory::<V, M, N>::change_state(&mut self.memory.0);
    }

    /// Goes on from another state at another time, as after an impact or a rest; what the method remembers is
    /// forgotten.
    pub fn restart_at(&mut self, time: f64, state: State<V::Scalar, N>) {
        let at = Checkpoint { state, step_size: self.at.step_size, origin: time, steps: 0 };
        *self = Self::resume(at);
    }

    /// A run with inputs of another system, of whatever type and number of coordinates, that goes on from
    /// `state` at the present time by the method and the step size of this one. Systems of the type of this
    /// one, with other fields, it is given itself.
    #[must_use]
    pub fn handed_to<T, const K: usize>(&self, state: State<T::Scalar, K>) -> DrivenTrajectory<T, M, K>
    where
        T: Flow<M, K, Scalar = V::Scalar>,
    {
        let Checkpoint { step_size, .. } = self.at;
        DrivenTrajectory::resume(Checkpoint { state, step_size, origin: self.time(), steps: 0 })
    }

    /// State, step size and clock as they are now. A run that is resumed from them solves its first steps
    /// without a guess, so that it may differ from this one by rounding, which
    /// [`checkpoint`](Self::checkpoint) avoids.
    #[must_use]
    pub fn present(&self) -> Checkpoint<V::Scalar, N> {
        self.at
    }

    /// All that is needed to go on from here; the run forgets what its method remembers, as one that is
    /// resumed has to: both go on bit by bit alike.
    pub fn checkpoint(&mut self) -> Checkpoint<V::Scalar, N> {
        self.memory = Remembered::default();
        self.at
    }

    /// Fails where `system`, which has the time that the run began with, is not to be stepped from here
    /// ([`Course::require_step`]).
    pub(super) fn require_step(&mut self, system: &V) -> Result<(), StepError> {
        self.course.require_step::<V, V::RunMemory, M, N>(system, &self.at)
    }

    /// Takes the step of `system`, which holds the input of this step.
    ///
    /// # Errors
    /// A [`StepError`]; the state is untouched, and of a rule's run every byte.
    #[inline]
    pub fn advance<L>(&mut self, system: &L) -> Result<Step<V::Scalar, N>, StepError>
    where
        L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
        V::RunMemory: Memory<L, M, N>,
    {
        if self.course == Course::Open { self.take(system) } else { self.take_watched(system) }
    }

    /// The next step of `system` on the way to `end`, with its size.
    pub(super) fn next_until<L>(&mut self, system: &L, end: f64) -> Option<TakenUntil<V::Scalar, N>>
    where
        L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
        V::RunMemory: Memory<L, M, N>,
    {
        let own = self.at.step_size;
        let size = match self.at.toward(end) {
            Toward::Nowhere => {
                self.at.settle(end);
                return None;
            }
            Toward::Grid => return Some(self.advance(system).map(|step| (step, own))),
            Toward::Last(size) => size,
        };
        self.at.step_size = size;
        let step = self.advance(system);
        self.at.step_size = own;
        Some(step.map(|step| {
            self.at.arrive(end);
            self.course = self.course.moved(&self.at);
            (step, size)
        }))
    }

    /// Changes nothing before the step is taken: one that fails then leaves every byte.
    #[inline]
    fn take<L>(&mut self, system: &L) -> Result<Step<V::Scalar, N>, StepError>
    where
        L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
        V::RunMemory: Memory<L, M, N>,
    {
        let step = Memory::<L, M, N>::advance(&mut self.memory.0, system, &self.at.state, self.at.step_size);
        if let Ok(step) = &step {
            Memory::<L, M, N>::change_input(&mut self.memory.0);
            self.at.follow(&step.state);
        }
        step
    }

    /// The first step of a run, or one that its clock may not tell from none.
    #[cold]
    #[inline(never)]
    fn take_watched<L>(&mut self, system: &L) -> Result<Step<V::Scalar, N>, StepError>
    where
        L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
        V::RunMemory: Memory<L, M, N>,
    {
        let course = self.course.after::<L, V::RunMemory, M, N>(system, &self.at)?;
        let step = self.take(system);
        if step.is_ok() {
            self.course = course;
        }
        step
    }

    /// Takes the step of `system`, and linearises its equations there: A, B and derivatives by parameters, by
    /// one factorisation.
    ///
    /// # Errors
    /// Those of [`advance`](Self::advance), and [`StepError::SingularNewtonMatrix`] where the step has no
    /// derivative: the state is then untouched, and [`advance`](Self::advance) takes the step.
    #[inline]
    pub fn advance_linearized<'a, L>(&mut self, system: &'a L) -> Result<StepTaken<'a, L, M, N>, StepError>
    where
        L: Linearizable<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
        V::RunMemory: Memory<L, M, N>,
    {
        let course = self.course.after::<L, V::RunMemory, M, N>(system, &self.at)?;
        let Checkpoint { state, step_size: h, .. } = self.at;
        let step = Memory::<L, M, N>::advance(&mut self.memory.0, system, &state, h)?;
        let taken = StepTaken::new(system, &self.memory.0, &state, step, h);
        Memory::<L, M, N>::change_input(&mut self.memory.0);
        if taken.is_err() {
            Memory::<L, M, N>::change_state(&mut self.memory.0);
        } else {
            self.course = course;
            self.at.follow(&step.state);
        }
        taken
    }
}
