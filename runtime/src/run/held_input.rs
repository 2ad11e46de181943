//! A run with inputs while one of them is held.

mod period;

use crate::numbers::Scalar;
use crate::run::between::{Dense, Divisible, LastStep, Moment, Restartable, SampledAt, Until};
use crate::run::events::Watch;
use crate::run::present::at_present;
use crate::run::{DrivenTrajectory, Run, TakenUntil};
use crate::step::{Flow, Memory, State, Step, StepError};

pub use period::{Carried, InPeriod, Period, Sensitivities};

/// Steps with one input.
impl<V, M, const N: usize> DrivenTrajectory<V, M, N>
where
    V: Flow<M, N>,
{
    /// This run while it takes the steps of `system`, which holds one input: [`HeldInput`].
    ///
    /// ```
    /// use dalembert::{Discretise, Gauss, State, rayleigh_system};
    ///
    /// struct Cart;
    ///
    /// #[rayleigh_system(rule = gauss)]
    /// impl Cart {
    ///     fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
    ///         0.5 * v[0] * v[0]
    ///     }
    ///     fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
    ///         u
    ///     }
    /// }
    ///
    /// let start = State::from_velocity(&Cart, [0.0], [0.0])?;
    /// let mut run = Cart.driven([0.0]).by(Gauss::<3>, 0.1).run_with_inputs(start);
    /// // Pushed until it is at 2, at t = 2, and braked until it rests, at t = 4.
    /// let push = Cart.driven([1.0]);
    /// let at = run.hold(&push).watch(|at| [at.q[0] - 2.0]).terminal([true]).next().unwrap()?;
    /// assert!((at.time - 2.0).abs() < 1e-13);
    /// let brake = Cart.driven([-1.0]);
    /// let rest = run.hold(&brake).watch(|at| [at.momentum()[0]]).next().unwrap()?;
    /// assert!((rest.time - 4.0).abs() < 1e-13 && (rest.state.q[0] - 4.0).abs() < 1e-13);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn hold<'r, 's, L>(&'r mut self, system: &'s L) -> HeldInput<'r, 's, L, V, M, N>
    where
        L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
        V::RunMemory: Memory<L, M, N>,
    {
        let since = self.time();
        HeldInput { run: self, system, since }
    }
}

/// A run with inputs while one of them is held, for one step or for several: [`DrivenTrajectory::hold`].
///
/// An iterator over steps, as a [`Trajectory`](crate::Trajectory) is: it can be looked into between them and
/// watched for events, and it can be restarted at one. A view that has a time has it at the moment from which
/// the input is held.
pub struct HeldInput<'r, 's, L, V, M, const N: usize>
where
    V: Flow<M, N>,
{
    run: &'r mut DrivenTrajectory<V, M, N>,
    system: &'s L,
    since: f64,
}

impl<L, V, M, const N: usize> HeldInput<'_, '_, L, V, M, N>
where
    V: Flow<M, N>,
    L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
    V::RunMemory: Memory<L, M, N>,
{
    /// The present state: that of the last step that succeeded.
    pub fn state(&self) -> &State<L::Scalar, N> {
        self.run.state()
    }

    /// The time of the run.
    pub fn time(&self) -> f64 {
        self.run.time()
    }

    at_present!(held => held.system, held.since);

    /// This run as one that answers for all times of its last step: [`Dense`].
    pub fn dense(&mut self) -> Dense<'_, Self, N> {
        Dense::new(self)
    }

    /// The steps up to `end`, where the run then stands: [`Until`]. A control period is one call, of any
    /// length beside that of the steps.
    pub fn until(&mut self, end: f64) -> Until<'_, Self, N> {
        Until::of(self, end)
    }

    /// The states at `times`, in the order of the run: [`SampledAt`].
    pub fn sample_at<I>(&mut self, times: I) -> SampledAt<'_, Self, N, I::IntoIter>
    where
        I: IntoIterator<Item = f64>,
    {
        SampledAt::of(self, times)
    }

    /// Watches this run for the events that the functions `g` vanish: [`Watch`].
    pub fn watch<G, const K: usize>(&mut self, g: G) -> Watch<'_, Self, G, N, K>
    where
        G: Fn(&Moment<'_, L, N>) -> [L::Scalar; K],
    {
        Watch::new(self, g)
    }
}

impl<L, V, M, const N: usize> Iterator for HeldInput<'_, '_, L, V, M, N>
where
    V: Flow<M, N>,
    L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
    V::RunMemory: Memory<L, M, N>,
{
    type Item = Result<Step<L::Scalar, N>, StepError>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let elapsed = L::Scalar::constant(self.run.time() - self.since);
        let run = &mut *self.run;
        Some(self.system.later(elapsed, |system| run.advance(system)))
    }
}

impl<L, V, M, const N: usize> Run<N> for HeldInput<'_, '_, L, V, M, N>
where
    V: Flow<M, N>,
    L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
    V::RunMemory: Memory<L, M, N>,
{
    type Scalar = L::Scalar;

    fn state(&self) -> &State<L::Scalar, N> {
        self.run.state()
    }

    fn time(&self) -> f64 {
        self.run.time()
    }
}

impl<L, V, M, const N: usize> Divisible<N> for HeldInput<'_, '_, L, V, M, N>
where
    V: Flow<M, N>,
    L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
    V::RunMemory: Memory<L, M, N>,
{
    type System = L;

    fn system(&self) -> &L {
        self.system
    }

    fn since(&self) -> f64 {
        self.since
    }

    fn step_size(&self) -> L::Scalar {
        self.run.step_size()
    }

    fn last_step(&self) -> &dyn LastStep<L, N> {
        &self.run.memory
    }
}

impl<L, V, M, const N: usize> Restartable<N> for HeldInput<'_, '_, L, V, M, N>
where
    V: Flow<M, N>,
    L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
    V::RunMemory: Memory<L, M, N>,
{
    fn restart_at(&mut self, time: f64, state: State<L::Scalar, N>) {
        self.run.restart_at(time, state);
    }

    fn next_until(&mut self, end: f64) -> Option<TakenUntil<L::Scalar, N>> {
        let elapsed = L::Scalar::constant(self.run.time() - self.since);
        let run = &mut *self.run;
        self.system.later(elapsed, |system| run.next_until(system, end))
    }
}
