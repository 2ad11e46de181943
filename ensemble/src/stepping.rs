//! How the members of a chunk are stepped.

use core::any::type_name;
use core::ops::ControlFlow;

use dalembert::run::Stop;
use dalembert::step::{Flow, MethodOf};
use dalembert::system::Scalar;
use dalembert::tolerance::{Methods, OffersMethods, ToleranceError};
use dalembert::{Discretise, Lagrangian, State, StepError};

use crate::member::{End, Failure, MemberError, Record, caught};

/// A member while it is stepped, and what is kept of it.
#[derive(Clone, Debug)]
pub struct Slot<L: Lagrangian<N>, V, const N: usize> {
    /// Its number.
    pub number: u64,
    /// Its system and start, or why there is none.
    pub start: Result<(L, State<L::Scalar, N>), StepError>,
    /// The value kept of it.
    pub value: V,
    /// Why it is not what was asked for.
    pub failure: Option<Failure<L::Scalar, N>>,
}

/// A member that has a start.
pub(crate) struct Started<'s, L: Lagrangian<N>, V, const N: usize> {
    pub(crate) number: u64,
    pub(crate) system: &'s L,
    pub(crate) start: State<L::Scalar, N>,
    pub(crate) value: &'s mut V,
    pub(crate) failure: &'s mut Option<Failure<L::Scalar, N>>,
}

impl<L: Lagrangian<N>, V, const N: usize> Slot<L, V, N> {
    /// The member, if it has a start; otherwise that is its failure.
    pub(crate) fn started(&mut self) -> Option<Started<'_, L, V, N>> {
        let Self { number, start, value, failure } = self;
        let number = *number;
        match start {
            Ok((system, start)) => Some(Started { number, system, start: *start, value, failure }),
            Err(error) => {
                *failure = Some(Failure { number, error: (*error).into(), last: None });
                None
            }
        }
    }
}

/// How the members of a chunk are stepped.
///
/// One of one's own may look for events: it hands them on as records ([`Record::event`]), in the order of
/// time.
pub trait Stepping<L: Lagrangian<N>, const N: usize>: Sync {
    /// Steps all of `members`; `observe` sees the records of each in the order of time, and says whether it
    /// goes on. Breaks where `stop` is asked to end, which it looks at some hundred steps apart at most: the
    /// members are then as they happen to be, and not looked at.
    fn advance<V>(
        &self,
        members: &mut [Slot<L, V, N>],
        observe: &impl Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<()>;

    /// Members that a thread takes at a time at least: one, where a member takes long.
    fn at_once(&self) -> u64 {
        64
    }

    /// How the members are stepped, in words: that two studies are the same.
    fn description(&self) -> String;

    /// Whether records may be of events: files have a column for them then.
    fn has_events(&self) -> bool {
        false
    }

    /// Numbers of a member's motion from its start, by which it is told from one that starts alike and moves
    /// otherwise, as with other fields. None unless it is implemented.
    fn at_start(&self, system: &L, start: &State<L::Scalar, N>) -> Vec<f64> {
        let _ = (system, start);
        Vec::new()
    }
}

/// Why the run of a member has no end.
pub(crate) enum NoEnd<S, const N: usize> {
    /// It fails.
    Failed(Failure<S, N>),
    /// The caller ends all.
    Stopped,
}

impl<S, const N: usize> From<Failure<S, N>> for NoEnd<S, N> {
    fn from(failure: Failure<S, N>) -> Self {
        Self::Failed(failure)
    }
}

/// The failure of a member after its run, if it has one; breaks where all end.
pub(crate) fn failed<S, const N: usize>(
    run: Result<(), NoEnd<S, N>>,
) -> ControlFlow<(), Option<Failure<S, N>>> {
    match run {
        Ok(()) => ControlFlow::Continue(None),
        Err(NoEnd::Failed(failure)) => ControlFlow::Continue(Some(failure)),
        Err(NoEnd::Stopped) => ControlFlow::Break(()),
    }
}

/// Steps one member after the other: `run` makes the run of each that has a start, given its number, system,
/// start and value, and says why it failed, if it did. Breaks where that does.
pub fn one_by_one<L: Lagrangian<N>, V, const N: usize>(
    members: &mut [Slot<L, V, N>],
    run: impl Fn(u64, &L, &State<L::Scalar, N>, &mut V) -> ControlFlow<(), Option<Failure<L::Scalar, N>>>,
) -> ControlFlow<()> {
    for Started { number, system, start, value, failure } in members.iter_mut().filter_map(Slot::started) {
        *failure = run(number, system, &start, value)?;
    }
    ControlFlow::Continue(())
}

/// Steps of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan<S> {
    /// The step size.
    pub h: S,
    /// The number of steps.
    pub steps: u64,
    /// Steps from one record to the next, the first at the start; `None`: the end alone is recorded.
    pub every: Option<u64>,
    /// The error at the end for which equations are solved; `None`: to rounding.
    pub error: Option<f64>,
}

/// Each member by its own [`Trajectory`](dalembert::Trajectory).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneByOne<M, S> {
    pub(crate) method: M,
    pub(crate) plan: Plan<S>,
}

impl<M, S> OneByOne<M, S> {
    /// By this method and plan.
    #[must_use]
    pub const fn new(method: M, plan: Plan<S>) -> Self {
        Self { method, plan }
    }
}

impl<L, M, const N: usize> Stepping<L, N> for OneByOne<M, L::Scalar>
where
    L: Flow<M, N>,
    M: Copy + Sync + MethodOf<L, N>,
{
    fn advance<V>(
        &self,
        members: &mut [Slot<L, V, N>],
        observe: &impl Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<()> {
        one_by_one(members, |number, system, start, value| {
            failed(self.plan.run(self.method, (number, system, start), |record| observe(value, record), stop))
        })
    }

    fn description(&self) -> String {
        self.plan.description::<M>()
    }

    fn at_start(&self, system: &L, start: &State<L::Scalar, N>) -> Vec<f64> {
        self.plan.first_step(self.method, system, start)
    }
}

impl<S: Scalar> Plan<S> {
    pub(crate) fn description<M>(&self) -> String {
        let Self { h, steps, every, error } = self;
        let solved = error.map_or_else(String::new, |error| format!(", solved for {error:?}"));
        format!("{}, h = {h:?}, {steps} steps, every {every:?}{solved}", type_name::<M>())
    }

    /// The state after one step; none where it fails.
    pub(crate) fn first_step<L, M, const N: usize>(
        &self,
        method: M,
        system: &L,
        start: &State<S, N>,
    ) -> Vec<f64>
    where
        L: Flow<M, N, Scalar = S>,
        M: MethodOf<L, N>,
    {
        let step = system.by(method, self.h).step(start);
        let state = step.iter().flat_map(|step| step.state.q.iter().chain(&step.state.p));
        state.map(|entry| entry.widen()).collect()
    }

    /// The time of the last step.
    pub(crate) fn time(&self) -> f64 {
        self.h.widen() * self.steps as f64
    }

    /// The trajectory of one member.
    pub(crate) fn run<L, M, const N: usize>(
        &self,
        method: M,
        (number, system, start): (u64, &L, &State<S, N>),
        mut observe: impl FnMut(&Record<'_, L, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> Result<(), NoEnd<S, N>>
    where
        L: Flow<M, N, Scalar = S>,
        M: MethodOf<L, N>,
    {
        let mut run = system.by(method, self.h).run(*start);
        if let Some(error) = self.error {
            run = run.solved_for(error, self.time());
        }
        let start = Record { number, system, steps: 0, time: 0.0, state: *start, event: None };
        if (self.every.is_some() || self.steps == 0) && observe(&start).is_break() {
            return Ok(());
        }
        let stride = self.every.unwrap_or(self.steps).max(1);
        let (mut steps, mut next) = (0, stride.min(self.steps));
        while steps < self.steps {
            if stop.is_asked() {
                return Err(NoEnd::Stopped);
            }
            let part = Stop::STRIDE.min(next - steps);
            // A trajectory ends after an error alone.
            let mut take = || (0..part).try_for_each(|_| run.next().map_or(Ok(()), |step| step.map(drop)));
            if let Err(error) = caught(&mut take).and_then(|taken| taken.map_err(MemberError::from)) {
                let last = Some(End { number, time: run.time(), state: *run.state() });
                return Err(Failure { number, error, last }.into());
            }
            steps += part;
            if steps < next {
                continue;
            }
            next = self.steps.min(steps.saturating_add(stride));
            let (time, state) = (run.time(), *run.state());
            let record = Record { number, system, steps, time, state, event: None };
            if observe(&record).is_break() {
                break;
            }
        }
        Ok(())
    }
}

/// Each member to a tolerance, by the method and step size that keep it
/// ([`TimedRequest::end`](dalembert::tolerance::TimedRequest::end)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToError {
    pub(crate) tolerance: f64,
    pub(crate) time: f64,
}

impl ToError {
    /// To the error `tolerance` until `time`.
    #[must_use]
    pub const fn new(tolerance: f64, time: f64) -> Self {
        Self { tolerance, time }
    }
}

impl<L, const N: usize> Stepping<L, N> for ToError
where
    L: OffersMethods<N>,
    L::Methods: Methods<L, N>,
{
    fn advance<V>(
        &self,
        members: &mut [Slot<L, V, N>],
        observe: &impl Fn(&mut V, &Record<'_, L, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<()> {
        one_by_one(members, |number, system, start, value| {
            let request = system.to_error(self.tolerance).until(self.time).stopped_by(stop);
            let reached = caught(|| request.end(start)).and_then(|end| end.map_err(MemberError::from));
            let reached = match reached {
                Ok(reached) => reached,
                Err(MemberError::Tolerance(ToleranceError::Stopped)) => return ControlFlow::Break(()),
                Err(error) => {
                    let last = Some(End { number, time: 0.0, state: *start });
                    return ControlFlow::Continue(Some(Failure { number, error, last }));
                }
            };
            let (steps, state) = (reached.choice.steps(), reached.state);
            let time = reached.choice.step_size() * steps as f64;
            // The end is the only record: nothing is left to be stopped.
            let _ = observe(value, &Record { number, system, steps, time, state, event: None });
            ControlFlow::Continue(None)
        })
    }

    fn at_start(&self, system: &L, start: &State<L::Scalar, N>) -> Vec<f64> {
        let Ok(v) = start.velocity(system) else { return Vec::new() };
        let (of_l, of_r) = (system.lagrangian_gradient(&start.q, &v), system.dissipation(&start.q, &v));
        let force = system.general_force(&start.q, &v);
        let vectors = [of_l.d1, of_l.d2, of_r.d1, of_r.d2, force];
        vectors.iter().flatten().map(|entry| entry.widen()).collect()
    }

    fn description(&self) -> String {
        format!("to the error {:?} until {:?}", self.tolerance, self.time)
    }
}
