//! Steps of members that are watched for events: each a run by itself, its events among its records.

use core::ops::ControlFlow;
use core::sync::atomic::{AtomicU64, Ordering};
use std::panic::{AssertUnwindSafe, catch_unwind};

use dalembert::run::Stop;
use dalembert::run::events::Watched as Next;
use dalembert::tolerance::ToleranceError;
use dalembert::{Lagrangian, State};
use dalembert_ensemble::{End, Failure, MemberError, Plan, Record, Slot, Stepping, one_by_one};

use crate::events::{Events, Function, of_block};
use crate::look::Look;
use crate::motion::Motion;
use crate::offer::{ErrorAsked, Steps, StepsToError};
use crate::system::System;

/// The steps of members, and the events that are looked for.
pub struct Watched<'a, S: System<N>, const N: usize> {
    /// The steps.
    pub steps: Unwatched<S, N>,
    /// The events.
    pub events: Events<'a>,
    /// A count of the members that are done, one by one: a study adds many at a time.
    pub done: &'a AtomicU64,
}

/// Steps as members take them that are not watched.
pub enum Unwatched<S, const N: usize> {
    /// Steps of one size.
    Fixed(Box<dyn Steps<S, N>>, Plan<f64>),
    /// Steps that a tolerance needs: of as many runs as it takes.
    ToError(Box<dyn StepsToError<S, N>>, ErrorAsked),
}

/// A run on its way. Its records are kept until it is known to be the member's.
struct Run<'m, L: Lagrangian<N, Scalar = f64>, const N: usize> {
    start: Record<'m, L, N>,
    last: Record<'m, L, N>,
    seen: Vec<Record<'m, L, N>>,
    end: Outcome<N>,
}

/// Why a run failed, if it did; breaks where it was stopped.
type Outcome<const N: usize> = ControlFlow<(), Option<Failure<f64, N>>>;

impl<'m, L: Lagrangian<N, Scalar = f64>, const N: usize> Run<'m, L, N> {
    fn new(number: u64, system: &'m L, state: State<f64, N>) -> Self {
        let start = Record { number, system, steps: 0, time: 0.0, state, event: None };
        Self { start, last: start, seen: Vec::new(), end: ControlFlow::Continue(None) }
    }

    /// Follows `motion` from the start.
    fn follow(&mut self, motion: &mut dyn Motion<N>, steps: u64, every: Option<u64>, stop: Stop<'_>) {
        *self = Self::new(self.start.number, self.start.system, self.start.state);
        self.end = self.go_on(motion, steps, every, stop);
    }

    fn go_on(
        &mut self,
        motion: &mut dyn Motion<N>,
        steps: u64,
        every: Option<u64>,
        stop: Stop<'_>,
    ) -> Outcome<N> {
        if every.is_some() || steps == 0 {
            self.seen.push(self.start);
        }
        let stride = every.unwrap_or(steps).max(1);
        while self.last.steps < steps {
            match motion.advance() {
                Some(Ok(Next::Step(_))) => {
                    let taken = self.last.steps + 1;
                    self.last =
                        Record { steps: taken, time: motion.time(), state: *motion.state(), ..self.last };
                    if taken.is_multiple_of(stride) || taken == steps {
                        self.seen.push(self.last);
                    }
                    if taken.is_multiple_of(Stop::STRIDE) && stop.is_asked() {
                        return ControlFlow::Break(());
                    }
                }
                Some(Ok(Next::Event(event))) => {
                    let (time, state, event) = (event.time, event.state, Some(event.index));
                    self.seen.push(Record { time, state, event, ..self.last });
                }
                Some(Err(error)) => return self.failed(error.into()),
                // An event has ended the run.
                None => {
                    self.seen.push(Record { time: motion.time(), state: *motion.state(), ..self.last });
                    break;
                }
            }
        }
        ControlFlow::Continue(None)
    }

    fn failed(&self, error: MemberError) -> Outcome<N> {
        let Record { number, time, state, .. } = self.last;
        ControlFlow::Continue(Some(Failure { number, error, last: Some(End { number, time, state }) }))
    }
}

impl<S: System<N>, const N: usize> Watched<'_, S, N> {
    /// Makes the run of a member.
    fn go_on(&self, run: &mut Run<'_, S::View<'_>, N>, stop: Stop<'_>) {
        let Record { system, state: start, .. } = run.start;
        let ran = catch_unwind(AssertUnwindSafe(|| match &self.steps {
            Unwatched::Fixed(by, Plan { h, steps, every, .. }) => {
                let mut record = |motion: &mut dyn Motion<N>| run.follow(motion, *steps, *every, stop);
                let look = Look { events: Some(self.events), ..Look::default() };
                by.run(system, *h, &start, look, &mut record);
                Ok(())
            }
            Unwatched::ToError(by, asked) => {
                let mut record = |motion: &mut dyn Motion<N>, steps| {
                    run.follow(motion, steps, None, stop);
                    match run.end {
                        ControlFlow::Continue(Some(Failure { error: MemberError::Step(error), .. })) => {
                            Some(error)
                        }
                        _ => None,
                    }
                };
                by.tried(system, *asked, &start, self.events, &mut record, stop)
            }
        }));
        match ran {
            Ok(Ok(())) => {}
            // A run that was stopped says nothing of its error.
            _ if run.end.is_break() => {}
            Ok(Err(ToleranceError::Stopped)) => run.end = ControlFlow::Break(()),
            Ok(Err(error)) => {
                // No run that was tried is the member's.
                (run.last, run.seen) = (run.start, Vec::new());
                run.end = run.failed(error.into());
            }
            Err(_) => run.end = run.failed(MemberError::Panicked),
        }
    }
}

impl<'v, S: System<N>, const N: usize> Stepping<S::View<'v>, N> for Watched<'_, S, N> {
    fn advance<V>(
        &self,
        members: &mut [Slot<S::View<'v>, V, N>],
        observe: &impl Fn(&mut V, &Record<'_, S::View<'v>, N>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<()> {
        one_by_one(members, |number, system, start, value| {
            let mut run = Run::new(number, system, *start);
            self.go_on(&mut run, stop);
            // A member that has arrived has no further records.
            let _ = run.seen.iter().try_for_each(|record| observe(value, record));
            self.done.fetch_add(1, Ordering::Relaxed);
            run.end
        })
    }

    fn at_once(&self) -> u64 {
        1
    }

    fn description(&self) -> String {
        let steps = match &self.steps {
            Unwatched::Fixed(by, plan) => by.together(*plan).description(),
            Unwatched::ToError(by, asked) => by.together(*asked).description(),
        };
        format!("{steps}, watched for {:?}", self.events.asked)
    }

    fn has_events(&self) -> bool {
        true
    }

    /// The values of functions that the description does not tell apart.
    fn at_start(&self, system: &S::View<'v>, start: &State<f64, N>) -> Vec<f64> {
        let Ok(v) = start.velocity(system) else { return Vec::new() };
        let Events { asked, origin } = self.events;
        let value = |function: &Function<'_>| match function {
            // Told apart by the description.
            Function::Plane { .. } | Function::Sphere { .. } | Function::Energy(_) => None,
            Function::OfBlock(index) => Some(of_block::<S::Events, _, N>(system, &start.q, &v, *index)),
            Function::Given(function) => Some(function(origin, start.q.as_slice(), v.as_slice())),
        };
        asked.iter().filter_map(|event| value(&event.function)).collect()
    }
}
