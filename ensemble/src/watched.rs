//! Members whose runs are watched for events: what is found stands among their records, and may end them.

use core::ops::ControlFlow;

use dalembert::run::Stop;
use dalembert::run::between::Moment;
use dalembert::run::events::{Crossing, Watched as Next};
use dalembert::step::{Flow, MethodOf};
use dalembert::system::Scalar;
use dalembert::{Discretise, Lagrangian, State};

use crate::member::{End, Failure, MemberError, Record, caught};
use crate::stepping::{OneByOne, Plan, Slot, Stepping, one_by_one};
use crate::study::Study;

/// Each member by its own [`Trajectory`](dalembert::Trajectory), watched for events.
#[derive(Clone, Copy, Debug)]
pub struct Watched<M, S, G, const K: usize> {
    method: M,
    plan: Plan<S>,
    g: G,
    crossings: [Crossing; K],
    terminal: [bool; K],
}

impl<'f, F, M, L, const N: usize> Study<'f, F, OneByOne<M, L::Scalar>, L, N>
where
    L: Flow<M, N>,
{
    /// Watches the run of each member for the events that the functions `g` vanish, such as those of its
    /// block ([`Moment::events`]). An event is a record ([`Record::event`]), between those of the steps; one
    /// that is `terminal` ends the member, whose last record has its time and state.
    ///
    /// Members are then stepped one by one, and not in lanes. Steps are those of a run that is not watched,
    /// bit by bit. Files have a column for events; they do not tell one `g` from another
    /// (`metadata` of the parts says it).
    ///
    /// ```
    /// use dalembert::{Midpoint, State, rayleigh_system};
    /// use dalembert_ensemble::Ensemble;
    ///
    /// struct Ball {
    ///     floor: f64,
    /// }
    /// #[rayleigh_system]
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
    /// let study = Ensemble::new(member).by(Midpoint, 0.3).steps(100).watch(|at| at.events(), [true]);
    /// for (k, end) in (1..9).zip(study.ends(1..9)?) {
    ///     assert!((end?.time - f64::from(k)).abs() < 1e-12);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn watch<G, const K: usize>(
        self,
        g: G,
        terminal: [bool; K],
    ) -> Study<'f, F, Watched<M, L::Scalar, G, K>, L, N>
    where
        G: Fn(&Moment<'_, L, N>) -> [L::Scalar; K] + Sync,
    {
        self.stepped_by(|OneByOne { method, plan }| {
            let crossings = [Crossing::Either; K];
            Watched { method, plan, g, crossings, terminal }
        })
    }
}

impl<F, M, L: Lagrangian<N>, G, const N: usize, const K: usize>
    Study<'_, F, Watched<M, L::Scalar, G, K>, L, N>
{
    /// Counts of each function the events of one direction only.
    pub fn crossing(mut self, crossings: [Crossing; K]) -> Self {
        self.stepping.crossings = crossings;
        self
    }
}

impl<L, M, G, const N: usize, const K: usize> Stepping<L, N> for Watched<M, L::Scalar, G, K>
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
        one_by_one(members, |number, system, start, value| {
            self.run((number, system, start), |record| observe(value, record), stop)
        })
    }

    fn description(&self) -> String {
        let Self { plan, crossings, terminal, .. } = self;
        format!("{}, watched for {crossings:?}, terminal {terminal:?}", plan.description::<M>())
    }

    fn has_events(&self) -> bool {
        true
    }

    fn at_start(&self, system: &L, start: &State<L::Scalar, N>) -> Vec<f64> {
        self.plan.first_step(self.method, system, start)
    }
}

impl<M, S: Scalar, G, const K: usize> Watched<M, S, G, K> {
    /// Makes the run of a member; the failure that ends it, if one does. Breaks where all end.
    fn run<L, const N: usize>(
        &self,
        (number, system, start): (u64, &L, &State<S, N>),
        mut observe: impl FnMut(&Record<'_, L, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<(), Option<Failure<S, N>>>
    where
        L: Flow<M, N, Scalar = S>,
        M: Copy + MethodOf<L, N>,
        G: Fn(&Moment<'_, L, N>) -> [S; K],
    {
        let Plan { h, steps, every, error } = self.plan;
        let mut run = system.by(self.method, h).run(*start);
        if let Some(error) = error {
            run = run.solved_for(error, self.plan.time());
        }
        let mut watch = run.watch(&self.g).crossing(self.crossings).terminal(self.terminal);
        let mut last = Record { number, system, steps: 0, time: 0.0, state: *start, event: None };
        let done = ControlFlow::Continue(None);
        if (every.is_some() || steps == 0) && observe(&last).is_break() {
            return done;
        }
        let stride = every.unwrap_or(steps).max(1);
        while last.steps < steps {
            let failed = |error| {
                let last = Some(End { number, time: last.time, state: last.state });
                ControlFlow::Continue(Some(Failure { number, error, last }))
            };
            let record = match caught(|| watch.advance()) {
                Ok(Some(Ok(Next::Step(step)))) => {
                    let taken = last.steps + 1;
                    last = Record { steps: taken, time: watch.run().time(), state: step.state, ..last };
                    if taken.is_multiple_of(Stop::STRIDE) && stop.is_asked() {
                        return ControlFlow::Break(());
                    }
                    if !taken.is_multiple_of(stride) && taken != steps {
                        continue;
                    }
                    last
                }
                Ok(Some(Ok(Next::Event(event)))) => {
                    Record { time: event.time, state: event.state, event: Some(event.index), ..last }
                }
                Ok(Some(Err(error))) => return failed(MemberError::from(error)),
                Err(error) => return failed(error),
                // An event has ended the run, which stands there.
                Ok(None) => {
                    let (time, state) = (watch.run().time(), *watch.run().state());
                    let _ = observe(&Record { time, state, ..last });
                    return done;
                }
            };
            if observe(&record).is_break() {
                return done;
            }
        }
        done
    }
}
