//! A run that is told its states: the one of a lane, to be watched or looked into.

use core::cell::Cell;
use core::marker::PhantomData;

use crate::numbers::Scalar;
use crate::run::between::{Divisible, Restartable};
use crate::run::last_step::{LastStep, Remembered};
use crate::run::{Run, TakenUntil};
use crate::step::{Flow, Memory, Report, State, Step, StepError};

/// Roundings of the time within which a step ends there.
const ROUNDINGS: f64 = 4.0;

/// A run whose states somebody else computes, as [`LaneRuns`](crate::run::LaneRuns) do: it takes a step
/// when it is told where that leads, and has none otherwise. It can be looked into and watched as the run
/// of its own that it stands for.
///
/// Of a Gauss rule of three stages or more the stages are not told: such runs are watched one by one.
///
/// ```
/// use dalembert::run::events::{Watch, Watched};
/// use dalembert::run::{LaneRuns, ToldRun};
/// use dalembert::{Splitting, State, rayleigh_system};
///
/// #[rayleigh_system(rule = trapezoidal, lanes = explicit)]
/// fn oscillator(q: [f64; 1], v: [f64; 1]) -> f64 {
///     0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
/// }
///
/// let (system, start) = (Oscillator {}, State { q: [1.0].into(), p: [0.0].into() });
/// let mut lanes = LaneRuns::new(Splitting::blanes_moan_6(), [&system; 2], &[start; 2], 0.25);
/// let mut run = ToldRun::new(Splitting::blanes_moan_6(), &system, start, 0.25);
/// let mut watch = Watch::new(&mut run, |at| [at.q[0]]);
/// let mut first = None;
/// while first.is_none() {
///     lanes.advance(1);
///     watch.run().tell(lanes.state(1).expect("an oscillator goes on"));
///     while let Some(Watched::Event(event)) = watch.advance().transpose()? {
///         first = Some(event.time);
///     }
/// }
/// assert!((first.unwrap() - core::f64::consts::FRAC_PI_2).abs() < 1e-6);
/// # Ok::<(), dalembert::run::events::EventError>(())
/// ```
pub struct ToldRun<'a, L, M, const N: usize>
where
    L: Flow<M, N>,
{
    system: &'a L,
    h: L::Scalar,
    state: State<L::Scalar, N>,
    /// Steps since `time`.
    steps: u64,
    began: f64,
    ahead: Cell<Option<State<L::Scalar, N>>>,
    memory: Remembered<M, L::RunMemory>,
    method: PhantomData<M>,
}

impl<'a, L, M, const N: usize> ToldRun<'a, L, M, N>
where
    L: Flow<M, N>,
{
    /// The run of `system` from `start` by steps of `h`.
    pub fn new(_method: M, system: &'a L, start: State<L::Scalar, N>, h: L::Scalar) -> Self {
        const {
            let nodes = <L::RunMemory as Memory<L, M, N>>::NODES;
            assert!(nodes.len() < 3, "the stages of a Gauss rule are not told: watch such runs one by one");
        }
        let (memory, ahead) = (Remembered::default(), Cell::new(None));
        Self { system, h, state: start, steps: 0, began: 0.0, ahead, memory, method: PhantomData }
    }

    /// Tells where the next step leads, which is then taken when it is asked for.
    pub fn tell(&self, state: State<L::Scalar, N>) {
        self.ahead.set(Some(state));
    }
}

impl<L, M, const N: usize> Iterator for ToldRun<'_, L, M, N>
where
    L: Flow<M, N>,
{
    type Item = Result<Step<L::Scalar, N>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        let state = self.ahead.take()?;
        let velocity = (state.q - self.state.q) / self.h;
        (self.state, self.steps) = (state, self.steps + 1);
        Some(Ok(Step { state, velocity, report: Report::of_no_equation() }))
    }
}

impl<L, M, const N: usize> Run<N> for ToldRun<'_, L, M, N>
where
    L: Flow<M, N>,
{
    type Scalar = L::Scalar;

    fn state(&self) -> &State<L::Scalar, N> {
        &self.state
    }

    fn time(&self) -> f64 {
        self.began + self.h.widen() * self.steps as f64
    }
}

impl<L, M, const N: usize> Divisible<N> for ToldRun<'_, L, M, N>
where
    L: Flow<M, N>,
{
    type System = L;

    fn system(&self) -> &L {
        self.system
    }

    fn step_size(&self) -> L::Scalar {
        self.h
    }

    fn last_step(&self) -> &dyn LastStep<L, N> {
        &self.memory
    }
}

impl<L, M, const N: usize> Restartable<N> for ToldRun<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// Stands at `state`; who tells it the next has to go on from there.
    fn restart_at(&mut self, time: f64, state: State<L::Scalar, N>) {
        (self.state, self.steps, self.began) = (state, 0, time);
        self.ahead.set(None);
    }

    fn next_until(&mut self, end: f64) -> Option<TakenUntil<L::Scalar, N>> {
        let (time, h) = (self.time(), self.h.widen());
        let left = end - time;
        if left * h <= 0.0 {
            return None;
        }
        if left.abs() >= h.abs() - ROUNDINGS * f64::EPSILON * end.abs().max(time.abs()) {
            return self.next().map(|taken| taken.map(|step| (step, self.h)));
        }
        // A shorter step than was told is made here.
        let (told, size) = (self.ahead.take()?, L::Scalar::constant(left));
        let mean = (told.q - self.state.q) / self.h;
        let made = self
            .system
            .later(L::Scalar::constant(time), |system| system.step(&self.state, size, Some(&mean)));
        Some(made.map(|step| {
            self.restart_at(end, step.state);
            (step, size)
        }))
    }
}
