//! One control period: its samples and events, and how its end and its samples follow its start.

use core::iter::Peekable;

use crate::numbers::Scalar;
use crate::run::HeldInput;
use crate::run::between::{Moment, Start};
use crate::run::checkpoint::is_same;
use crate::run::events::{Crossing, Event, EventError, Watch};
use crate::step::{
    DiscreteDriven, DiscreteParameters, Flow, Linearizable, Linearization, Memory, PhaseMatrix, State,
    StateBy, Step, StepError,
};
use crate::system::Lagrangian;

/// One control period.
impl<'r, 's, L, V, M, const N: usize> HeldInput<'r, 's, L, V, M, N>
where
    V: Flow<M, N>,
    L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
    V::RunMemory: Memory<L, M, N>,
{
    /// This run up to `end`, with the states at the times `samples` and the events of the functions `g` on
    /// the way, in the order of time: [`Period`].
    ///
    /// ```
    /// use dalembert::run::{HeldInput, InPeriod};
    /// use dalembert::step::Linearization;
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// struct Mass;
    ///
    /// #[rayleigh_system]
    /// impl Mass {
    ///     fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
    ///         0.5 * v[0] * v[0]
    ///     }
    ///     fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
    ///         u
    ///     }
    /// }
    ///
    /// let start = State::from_velocity(&Mass, [0.0], [1.0])?;
    /// let mut run = Mass.driven([0.0]).by(Midpoint, 0.01).run_with_inputs(start);
    /// let pushed = Mass.driven([2.0]);
    /// let mut held = run.hold(&pushed);
    /// // 25 ms: two steps and a half; a sensor at 12 ms, no events.
    /// let mut period = held.period(0.025, [0.012], |_| []).linearized::<Linearization<f64, 1, 1>>();
    /// while let Some(item) = period.advance() {
    ///     if let InPeriod::Sample { time, state } = item? {
    ///         assert!((state.q[0] - (time + time * time)).abs() < 1e-15);
    ///         let by = period.derivatives()?; // of the sample
    ///         assert!((by.b.q[0] - 0.5 * time * time).abs() < 1e-15);
    ///     }
    /// }
    /// let by = period.derivatives()?; // of the end of the period
    /// assert!((by.a.q_by_p[0] - 0.025).abs() < 1e-15 && (by.b.p[0] - 0.025).abs() < 1e-15);
    /// assert_eq!(run.time(), 0.025);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn period<I, G, const K: usize>(
        &mut self,
        end: f64,
        samples: I,
        g: G,
    ) -> Period<'_, 'r, 's, L, V, M, G, I::IntoIter, (), N, K>
    where
        I: IntoIterator<Item = f64>,
        G: Fn(&Moment<'_, L, N>) -> [L::Scalar; K],
    {
        Period {
            watch: Watch::new(self, g).until(end),
            times: samples.into_iter().peekable(),
            carry: None,
            at_start: (),
            at_end: (),
            shown: (),
            interrupted: None,
            has_failed: false,
        }
    }
}

/// One control period of a run, under one input: [`HeldInput::period`].
///
/// Samples are those of [`sample_at`](HeldInput::sample_at), events those of a [`Watch`]; both come in the
/// order of time, a sample at the time of an event before it. The run takes the steps of
/// [`until`](HeldInput::until), and stands at the end of the period when it is over. A time after that is an
/// error, as is one before the period.
pub struct Period<'t, 'r, 's, L, V, M, G, I, D, const N: usize, const K: usize>
where
    V: Flow<M, N>,
    L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
    V::RunMemory: Memory<L, M, N>,
    I: Iterator<Item = f64>,
{
    watch: Watch<'t, HeldInput<'r, 's, L, V, M, N>, G, N, K>,
    times: Peekable<I>,
    /// How derivatives are carried over a step, where they are.
    carry: Option<Carry<L, M, D, N>>,
    /// Derivatives by the start of the period, of where the last step began and ended.
    at_start: D,
    at_end: D,
    /// The derivatives of the last item.
    shown: D,
    /// The terminal event, from which the run went on.
    interrupted: Option<(usize, f64)>,
    has_failed: bool,
}

/// The derivatives after a step that led from a state by h and left the memory.
type Carry<L, M, D, const N: usize> = fn(
    &D,
    &L,
    &<L as Flow<M, N>>::RunMemory,
    &State<<L as Lagrangian<N>>::Scalar, N>,
    &Step<<L as Lagrangian<N>>::Scalar, N>,
    <L as Lagrangian<N>>::Scalar,
) -> Result<D, StepError>;

/// An item of a control period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InPeriod<S, const N: usize> {
    /// The state at a time that was asked for.
    Sample {
        /// The time.
        time: f64,
        /// The state.
        state: State<S, N>,
    },
    /// An event.
    Event(Event<S, N>),
    /// A step of the run.
    Step(Step<S, N>),
}

/// Derivatives that are carried along a control period, by its start: A ([`PhaseMatrix`]), with B
/// ([`Linearization`]), with B and those by parameters ([`Sensitivities`]).
pub trait Carried<L: Linearizable<M, N>, M, const N: usize>: Copy {
    /// The derivatives of the start itself.
    fn identity() -> Self;

    /// The derivatives after a step with these equations.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    fn after(&self, step: &L::Linearized<'_>) -> Result<Self, StepError>;
}

/// Derivatives of a state by the start of its control period, the input u and the parameters θ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensitivities<S, const N: usize, const U: usize, const P: usize> {
    /// A = ∂(q, p)/∂(q0, p0).
    pub a: PhaseMatrix<S, N>,
    /// B = ∂(q, p)/∂u, the input being held.
    pub b: StateBy<S, N, U>,
    /// ∂(q, p)/∂θ.
    pub by_parameters: StateBy<S, N, P>,
}

impl<'t, 'r, 's, L, V, M, G, I, D, const N: usize, const K: usize> Period<'t, 'r, 's, L, V, M, G, I, D, N, K>
where
    V: Flow<M, N>,
    L: Flow<M, N, Scalar = V::Scalar, RunMemory = V::RunMemory>,
    V::RunMemory: Memory<L, M, N>,
    G: Fn(&Moment<'_, L, N>) -> [L::Scalar; K],
    I: Iterator<Item = f64>,
    D: Copy,
{
    /// Counts of each function the events of one direction only.
    #[must_use]
    pub fn crossing(self, crossings: [Crossing; K]) -> Self {
        Self { watch: self.watch.crossing(crossings), ..self }
    }

    /// Which events end the period, unless it is [restarted](Self::restart).
    #[must_use]
    pub fn terminal(self, terminal: [bool; K]) -> Self {
        Self { watch: self.watch.terminal(terminal), ..self }
    }

    /// Carries derivatives along, `E` saying which: one linearisation a step and a sample.
    #[must_use]
    pub fn linearized<E>(self) -> Period<'t, 'r, 's, L, V, M, G, I, E, N, K>
    where
        L: Linearizable<M, N>,
        E: Carried<L, M, N>,
    {
        let Self { watch, times, interrupted, has_failed, .. } = self;
        let [at_start, at_end, shown] = [E::identity(); 3];
        let carry: Carry<L, M, E, N> =
            |by, system, memory, state, step, h| by.after(&system.linearized(memory, state, step, h)?);
        Period { watch, times, carry: Some(carry), at_start, at_end, shown, interrupted, has_failed }
    }

    /// Goes on from another state at the present time of the run, that of a terminal event.
    pub fn restart(&mut self, state: State<L::Scalar, N>) {
        self.watch.restart(state);
    }

    /// The run: at the end of the step that the items come from.
    #[must_use]
    pub fn run(&self) -> &HeldInput<'r, 's, L, V, M, N> {
        self.watch.run()
    }

    /// The derivatives of the last sample or step, by the start of the period.
    ///
    /// # Errors
    /// [`EventError::Restarted`] after a terminal event: it says which. Its own derivatives are
    /// [`Event::derivatives`].
    pub fn derivatives(&self) -> Result<&D, EventError> {
        match self.interrupted {
            Some((index, time)) => Err(EventError::Restarted { index, time }),
            None => Ok(&self.shown),
        }
    }

    /// The next item; `None` where the period is over, at its end or by a terminal event.
    ///
    /// # Errors
    /// [`EventError`], after which the period is over.
    pub fn advance(&mut self) -> Option<Result<InPeriod<L::Scalar, N>, EventError>> {
        if self.has_failed {
            return None;
        }
        let item = self.item().transpose();
        self.has_failed = matches!(item, Some(Err(_)));
        item
    }

    fn item(&mut self) -> Result<Option<InPeriod<L::Scalar, N>>, EventError> {
        loop {
            let event = self.watch.pending();
            let now = self.watch.run().time();
            let backwards = self.watch.run().run.step_size() < L::Scalar::constant(0.0);
            let reach = event.map_or(now, |(time, _)| time);
            let is_within = |time: &f64| if backwards { *time >= reach } else { *time <= reach };
            if let Some(time) = self.times.next_if(|time| is_within(time) || is_same(*time, reach)) {
                return self.sample(time, if is_same(time, now) { now } else { time }).map(Some);
            }
            if let Some((_, is_terminal)) = event {
                let event = self.watch.advance_to_event().transpose()?;
                if let (true, Some(event)) = (is_terminal, &event) {
                    self.interrupted.get_or_insert((event.index, event.time));
                }
                return Ok(event.map(InPeriod::Event));
            }
            if let Some(step) = self.watch.take_kept() {
                self.shown = self.at_end;
                return Ok(Some(InPeriod::Step(step)));
            }
            let Some(looked) = self.watch.look() else {
                return match self.times.next() {
                    Some(time) if self.interrupted.is_none() => {
                        Err(EventError::Time(self.watch.dense().outside(time)))
                    }
                    _ => Ok(None),
                };
            };
            self.follow(looked?)?;
        }
    }

    /// Carries the derivatives over the step that was taken.
    fn follow(&mut self, step: Step<L::Scalar, N>) -> Result<(), EventError> {
        let (Some(carry), Some(&Start { state, time, size, .. })) = (self.carry, self.watch.dense().start())
        else {
            return Ok(());
        };
        self.at_start = self.at_end;
        let HeldInput { run, system, since } = self.watch.run();
        let elapsed = L::Scalar::constant(time - since);
        let after = |system: &L| carry(&self.at_start, system, &run.memory.0, &state, &step, size);
        match system.later(elapsed, after) {
            Ok(after) => self.at_end = after,
            Err(error) => return Err(self.watch.refuse(error.into(), time)),
        }
        Ok(())
    }

    /// The state at a `time` within the last step, and its derivatives.
    fn sample(&mut self, asked: f64, time: f64) -> Result<InPeriod<L::Scalar, N>, EventError> {
        let dense = self.watch.dense();
        let (now, state) = (dense.run().time(), *dense.run().state());
        if time == now {
            self.shown = self.at_end;
            return Ok(InPeriod::Sample { time: asked, state });
        }
        let state = dense.state_at(time).map_err(EventError::Time)?;
        if let (Some(carry), Some(&Start { state: from, time: begun, .. })) = (self.carry, dense.start()) {
            let HeldInput { system, since, .. } = dense.run();
            let size = L::Scalar::constant(time - begun);
            let mut memory = L::RunMemory::default();
            self.shown = system.later(L::Scalar::constant(begun - since), |system| {
                let step = Memory::<L, M, N>::advance(&mut memory, system, &from, size)?;
                carry(&self.at_start, system, &memory, &from, &step, size)
            })?;
        }
        Ok(InPeriod::Sample { time: asked, state })
    }
}

impl<L: Linearizable<M, N>, M, const N: usize> Carried<L, M, N> for PhaseMatrix<L::Scalar, N> {
    fn identity() -> Self {
        PhaseMatrix::identity()
    }

    fn after(&self, step: &L::Linearized<'_>) -> Result<Self, StepError> {
        Ok(L::by_state(step)? * *self)
    }
}

impl<L, M, const N: usize, const U: usize> Carried<L, M, N> for Linearization<L::Scalar, N, U>
where
    L: Linearizable<M, N> + DiscreteDriven<M, N, U>,
{
    fn identity() -> Self {
        Self { a: PhaseMatrix::identity(), b: StateBy::zero() }
    }

    fn after(&self, step: &L::Linearized<'_>) -> Result<Self, StepError> {
        let a = L::by_state(step)?;
        Ok(Self { a: a * self.a, b: L::by_input(step)? + a * self.b })
    }
}

impl<L, M, const N: usize, const U: usize, const P: usize> Carried<L, M, N>
    for Sensitivities<L::Scalar, N, U, P>
where
    L: Linearizable<M, N> + DiscreteDriven<M, N, U> + DiscreteParameters<M, N, P>,
{
    fn identity() -> Self {
        Self { a: PhaseMatrix::identity(), b: StateBy::zero(), by_parameters: StateBy::zero() }
    }

    fn after(&self, step: &L::Linearized<'_>) -> Result<Self, StepError> {
        let a = L::by_state(step)?;
        Ok(Self {
            a: a * self.a,
            b: L::by_input(step)? + a * self.b,
            by_parameters: L::by_parameters(step)? + a * self.by_parameters,
        })
    }
}
