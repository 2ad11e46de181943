//! Members whose runs are watched for events: what is found stands among their records, and may end them.

use core::ops::ControlFlow;

use dalembert::run::between::Moment;
use dalembert::run::events::{Crossing, EventError, Watch, Watched as Next};
use dalembert::run::{Run, Stop, ToldRun};
use dalembert::step::{Flow, FlowInLanes, MethodOf};
use dalembert::system::Scalar;
use dalembert::{Discretise, Lagrangian, State};

use crate::lanes::{InLane, SideBySide, unseen};
use crate::member::{End, Failure, MemberError, Record, caught};
use crate::stepping::{OneByOne, Plan, Slot, Started, Stepping, one_by_one};
use crate::study::Study;

/// Each member by a run of its own, or in a lane, watched for events.
#[derive(Clone, Copy, Debug)]
pub struct Watched<B, G, const K: usize> {
    by: B,
    g: G,
    crossings: [Crossing; K],
    terminal: [bool; K],
}

/// Steps of one size, whose runs can be watched.
pub trait OfOneSize: sealed::Sealed {}

impl<M, S> OfOneSize for OneByOne<M, S> {}
impl<M, S> OfOneSize for SideBySide<M, S> {}

mod sealed {
    pub trait Sealed {}

    impl<M, S> Sealed for crate::OneByOne<M, S> {}
    impl<M, S> Sealed for crate::SideBySide<M, S> {}
}

impl<'f, F, B: OfOneSize, L: Lagrangian<N>, const N: usize> Study<'f, F, B, L, N> {
    /// Watches the run of each member for the events that the functions `g` vanish, such as those of its
    /// block ([`Moment::events`]). An event is a record ([`Record::event`]), between those of the steps; one
    /// that is `terminal` ends the member, whose last record has its time and state.
    ///
    /// Steps are those of a run that is not watched, bit by bit. Files have a column for events; they do not
    /// tell one `g` from another (`metadata` of the parts says it).
    ///
    /// Members are stepped one by one, or [in lanes](Self::in_lanes), where each is looked at after every
    /// step; runs of Gauss rules of three stages or more are watched one by one.
    ///
    /// ```
    /// use dalembert::{Midpoint, State, rayleigh_system};
    /// use dalembert_ensemble::Ensemble;
    ///
    /// struct Ball {
    ///     floor: f64,
    /// }
    /// #[rayleigh_system(lanes = midpoint)]
    /// impl Ball {
    ///     fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
    ///         0.5 * v[0] * v[0] - q[0]
    ///     }
    ///     fn events(&self, q: [f64; 1], _v: [f64; 1]) -> [f64; 1] {
    ///         [q[0] - self.floor]
    ///     }
    /// }
    /// // Dropped from the height k²/2 + 0.02, each lands on its floor after k time units.
    /// let member = |number: u64| {
    ///     let ball = Ball { floor: 0.02 };
    ///     Ok((ball, State { q: [0.5 * (number * number) as f64 + 0.02].into(), p: [0.0].into() }))
    /// };
    /// let study = || Ensemble::new(member).by(Midpoint, 0.3).steps(100);
    /// for (k, end) in (1..9).zip(study().watch(|at| at.events(), [true]).ends(1..9)?) {
    ///     assert!((end?.time - f64::from(k)).abs() < 1e-12);
    /// }
    /// for (k, end) in (1..9).zip(study().in_lanes().watch(|at| at.events(), [true]).ends(1..9)?) {
    ///     assert!((end?.time - f64::from(k)).abs() < 1e-12);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn watch<G, const K: usize>(self, g: G, terminal: [bool; K]) -> Study<'f, F, Watched<B, G, K>, L, N>
    where
        G: Fn(&Moment<'_, L, N>) -> [L::Scalar; K] + Sync,
    {
        self.stepped_by(|by| Watched { by, g, crossings: [Crossing::Either; K], terminal })
    }
}

impl<F, B, L: Lagrangian<N>, G, const N: usize, const K: usize> Study<'_, F, Watched<B, G, K>, L, N> {
    /// Counts of each function the events of one direction only.
    pub fn crossing(mut self, crossings: [Crossing; K]) -> Self {
        self.stepping.crossings = crossings;
        self
    }
}

impl<B, G, const K: usize> Watched<B, G, K> {
    /// How the members are stepped and watched, in words.
    fn described(&self, steps: &str) -> String {
        let Self { crossings, terminal, .. } = self;
        format!("{steps}, watched for {crossings:?}, terminal {terminal:?}")
    }
}

/// The records of a run, as what is found of it comes.
struct Recording<'s, L: Lagrangian<N>, const N: usize> {
    last: Record<'s, L, N>,
    steps: u64,
    every: Option<u64>,
}

/// An item of a run, as a record.
enum Recorded<'s, L: Lagrangian<N>, const N: usize> {
    /// A step, and the record that it is, if it is one.
    Step(Option<Record<'s, L, N>>),
    Event(Record<'s, L, N>),
    /// An event has ended the run, which stands there.
    End(Record<'s, L, N>),
    Failed(Failure<L::Scalar, N>),
}

impl<'s, L: Lagrangian<N>, const N: usize> Recording<'s, L, N> {
    fn new<S>(number: u64, system: &'s L, state: State<L::Scalar, N>, plan: &Plan<S>) -> Self {
        let last = Record { number, system, steps: 0, time: 0.0, state, event: None };
        Self { last, steps: plan.steps, every: plan.every }
    }

    /// The record at the start, if it is one.
    fn start(&self) -> Option<Record<'s, L, N>> {
        (self.every.is_some() || self.steps == 0).then_some(self.last)
    }

    fn failed(&self, error: MemberError) -> Failure<L::Scalar, N> {
        let Record { number, time, state, .. } = self.last;
        Failure { number, error, last: Some(End { number, time, state }) }
    }

    /// This item of `run` as a record.
    fn record(
        &mut self,
        item: Option<Result<Next<L::Scalar, N>, EventError>>,
        run: &impl Run<N, Scalar = L::Scalar>,
    ) -> Recorded<'s, L, N> {
        match item {
            Some(Ok(Next::Step(step))) => {
                let steps = self.last.steps + 1;
                self.last = Record { steps, time: run.time(), state: step.state, ..self.last };
                let stride = self.every.unwrap_or(self.steps).max(1);
                Recorded::Step((steps.is_multiple_of(stride) || steps == self.steps).then_some(self.last))
            }
            Some(Ok(Next::Event(event))) => {
                let (time, state, event) = (event.time, event.state, Some(event.index));
                Recorded::Event(Record { time, state, event, ..self.last })
            }
            Some(Err(error)) => Recorded::Failed(self.failed(error.into())),
            None => Recorded::End(Record { time: run.time(), state: *run.state(), ..self.last }),
        }
    }
}

impl<L, M, G, const N: usize, const K: usize> Stepping<L, N> for Watched<OneByOne<M, L::Scalar>, G, K>
where
    L: Flow<M, N>,
    M: Copy + Sync + MethodOf<L, N>,
    G: Fn(&Moment<'_, L, N>) -> [L::Scalar; K] + Sync,
{
    fn advance<V>(
        &self,
        members: &mut [Slot<L, V, N>],
        observe: &impl Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<()> {
        let OneByOne { method, plan } = self.by;
        one_by_one(members, |number, system, start, value| {
            self.run((method, plan), (number, system, start), |record| observe(value, record), stop)
        })
    }

    fn description(&self) -> String {
        self.described(&Stepping::<L, N>::description(&self.by))
    }

    fn has_events(&self) -> bool {
        true
    }

    fn at_start(&self, system: &L, start: &State<L::Scalar, N>) -> Vec<f64> {
        self.by.at_start(system, start)
    }
}

impl<B, G, const K: usize> Watched<B, G, K> {
    /// Makes the run of a member; the failure that ends it, if one does. Breaks where all end.
    fn run<L, M, S: Scalar, const N: usize>(
        &self,
        (method, plan): (M, Plan<S>),
        (number, system, start): (u64, &L, &State<S, N>),
        mut observe: impl FnMut(&Record<'_, L, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<(), Option<Failure<S, N>>>
    where
        L: Flow<M, N, Scalar = S>,
        M: Copy + MethodOf<L, N>,
        G: Fn(&Moment<'_, L, N>) -> [S; K],
    {
        let mut run = system.by(method, plan.h).run(*start);
        if let Some(error) = plan.error {
            run = run.solved_for(error, plan.time());
        }
        let mut watch = run.watch(&self.g).crossing(self.crossings).terminal(self.terminal);
        let mut recording = Recording::new(number, system, *start, &plan);
        let done = ControlFlow::Continue(None);
        if recording.start().is_some_and(|start| observe(&start).is_break()) {
            return done;
        }
        while recording.last.steps < plan.steps {
            let item = match caught(|| watch.advance()) {
                Ok(item) => item,
                Err(error) => return ControlFlow::Continue(Some(recording.failed(error))),
            };
            let record = match recording.record(item, watch.run()) {
                Recorded::Step(record) => {
                    if recording.last.steps.is_multiple_of(Stop::STRIDE) && stop.is_asked() {
                        return ControlFlow::Break(());
                    }
                    record
                }
                Recorded::Event(record) => Some(record),
                Recorded::End(record) => {
                    let _ = observe(&record);
                    return done;
                }
                Recorded::Failed(failure) => return ControlFlow::Continue(Some(failure)),
            };
            if record.is_some_and(|record| observe(&record).is_break()) {
                return done;
            }
        }
        done
    }
}

impl<L, M, G, const N: usize, const K: usize> Stepping<L, N> for Watched<SideBySide<M, L::Scalar>, G, K>
where
    L: FlowInLanes<M, N>,
    M: Copy + Sync + MethodOf<L, N>,
    G: Fn(&Moment<'_, L, N>) -> [L::Scalar; K] + Sync,
{
    fn advance<V>(
        &self,
        members: &mut [Slot<L, V, N>],
        observe: &impl Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<()> {
        let SideBySide { method, plan } = self.by;
        // A watch borrows its run: these stand apart.
        let mut told: Vec<_> = members
            .iter_mut()
            .filter_map(Slot::started)
            .map(|member| {
                let Started { number, system, start, .. } = member;
                let recording = Recording::new(number, system, start, &plan);
                (ToldRun::new(method, system, start, plan.h), recording, member)
            })
            .collect();
        let waiting = told.iter_mut().map(|(run, recording, member)| {
            let watch = Watch::new(run, &self.g).crossing(self.crossings).terminal(self.terminal);
            WatchedInLane { by: self, observe, watch, recording, member, seen: 0 }
        });
        self.by.advance_in_lanes(waiting, stop)
    }

    fn description(&self) -> String {
        self.described(&Stepping::<L, N>::description(&self.by))
    }

    fn has_events(&self) -> bool {
        true
    }

    fn at_start(&self, system: &L, start: &State<L::Scalar, N>) -> Vec<f64> {
        self.by.at_start(system, start)
    }
}

/// A member in a lane, which tells its run each state.
struct WatchedInLane<'t, 's, 'p, L, M, V, G, O, const N: usize, const K: usize>
where
    L: FlowInLanes<M, N>,
{
    by: &'p Watched<SideBySide<M, L::Scalar>, G, K>,
    observe: &'p O,
    watch: Watch<'t, ToldRun<'s, L, M, N>, &'p G, N, K>,
    recording: &'t mut Recording<'s, L, N>,
    member: &'t mut Started<'s, L, V, N>,
    /// Records that were observed.
    seen: u64,
}

impl<'s, L, M, V, G, O, const N: usize, const K: usize> WatchedInLane<'_, 's, '_, L, M, V, G, O, N, K>
where
    L: FlowInLanes<M, N>,
    O: Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
{
    /// Observes a record; whether the member goes on.
    fn goes_on(&mut self, record: &Record<'s, L, N>) -> bool {
        let observed = (self.observe)(self.member.value, record);
        self.seen += 1;
        observed.is_continue()
    }
}

impl<'s, L, M, V, G, O, const N: usize, const K: usize> InLane<'s, L, N>
    for WatchedInLane<'_, 's, '_, L, M, V, G, O, N, K>
where
    L: FlowInLanes<M, N>,
    M: Copy + MethodOf<L, N>,
    G: Fn(&Moment<'_, L, N>) -> [L::Scalar; K],
    O: Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
{
    fn system(&self) -> &'s L {
        self.member.system
    }

    fn start(&self) -> State<L::Scalar, N> {
        self.member.start
    }

    fn first(&self) -> u64 {
        u64::from(self.recording.start().is_none())
    }

    fn look(&mut self, state: State<L::Scalar, N>) -> ControlFlow<(), Option<u64>> {
        let (on, done) = (ControlFlow::Continue(Some(1)), ControlFlow::Continue(None));
        if self.recording.last.steps == 0
            && self.seen == 0
            && let Some(start) = self.recording.start()
        {
            let goes_on = self.goes_on(&start) && self.recording.steps > 0;
            return if goes_on { on } else { done };
        }
        self.watch.run().tell(state);
        loop {
            match self.recording.record(self.watch.advance(), self.watch.run()) {
                Recorded::Step(record) => {
                    let goes_on = record.is_none_or(|record| self.goes_on(&record));
                    let is_last = self.recording.last.steps == self.recording.steps;
                    return if goes_on && !is_last { on } else { done };
                }
                Recorded::Event(record) => {
                    if !self.goes_on(&record) {
                        return done;
                    }
                }
                Recorded::End(record) => {
                    let _ = self.goes_on(&record);
                    return done;
                }
                Recorded::Failed(failure) => {
                    *self.member.failure = Some(failure);
                    return done;
                }
            }
        }
    }

    #[cold]
    fn alone(&mut self, stop: Stop<'_>) -> ControlFlow<()> {
        let SideBySide { method, plan } = self.by.by;
        let Started { number, system, start, value, failure } = &mut *self.member;
        let observe = unseen(self.seen, |record: &Record<'_, L, N>| (self.observe)(value, record));
        **failure = self.by.run((method, plan), (*number, system, start), observe, stop)?;
        ControlFlow::Continue(())
    }
}
