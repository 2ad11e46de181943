//! The records of a run.

use std::collections::TryReserveError;

use dalembert::nalgebra::SVector;
use dalembert::run::Stop as Told;
use dalembert::run::events::{EventError, Watched};
use dalembert::tolerance::Breach;
use dalembert::{State, StepError};

use crate::derivatives::{column_rows, matrix_rows};
use crate::events::Found;
use crate::motion::{At, Motion};
pub use crate::refusal::Failure;
use crate::watch::Watch;

/// The records that are asked of a run.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    /// Steps in all, or about as many of a run that ends by itself.
    pub steps: u64,
    /// Whether it does.
    pub ends_by_itself: bool,
    /// Which states.
    pub recorded: Recorded<'a>,
    /// The time at the start.
    pub origin: f64,
    /// Event functions.
    pub events: usize,
}

/// The states of a run that are recorded.
#[derive(Clone, Copy, Debug)]
pub enum Recorded<'a> {
    /// The start, the end and those after every so many steps.
    Every(u64),
    /// The states at these times, in the order of the run.
    At(&'a [Timed]),
}

/// A time at which a state is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Timed {
    /// The time, as it was given.
    pub time: f64,
    /// The time from the start.
    pub elapsed: f64,
}

/// The records of a run, one after the other: vectors and matrices row by row.
#[derive(Clone, Debug, Default)]
pub struct Record {
    /// Times.
    pub t: Vec<f64>,
    /// Configurations.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Momenta.
    pub p: Vec<f64>,
    /// Energies.
    pub energy: Vec<f64>,
    /// ∂(q, p)/∂(q0, p0), where it was asked for.
    pub by_start: Vec<f64>,
    /// ∂(q, p)/∂θ.
    pub by_parameters: Vec<f64>,
    /// λ, where it was asked for.
    pub reactions: Vec<f64>,
    /// Steps taken.
    pub steps: u64,
    /// Iterations of the solver in all.
    pub iterations: u64,
    /// The events of each function.
    pub events: Vec<Found>,
}

/// Why a record ends before its run.
#[derive(Clone, Debug)]
pub enum Stop {
    /// A step failed.
    Failed(Failure),
    /// The watcher has called it off.
    Interrupted,
    /// Events cannot be followed.
    Events(EventError),
    /// So many records do not fit into memory.
    TooLarge(TryReserveError),
}

/// The method and step size chosen for a tolerance, and where the run passed it.
#[derive(Clone, Debug)]
pub struct Guarded {
    /// The method chosen.
    pub method: String,
    /// The step size chosen.
    pub h: f64,
    /// The error expected at the end.
    pub expected: f64,
    /// Where it passed the tolerance.
    pub breach: Option<Breach>,
}

impl Record {
    /// Records `motion`; `watch` is told from time to time of the steps taken, and may call it off.
    pub fn of<const N: usize>(
        motion: &mut dyn Motion<N>,
        plan: &Plan<'_>,
        watch: &Watch<'_>,
    ) -> (Self, Option<Stop>) {
        let mut record = Self { events: vec![Found::default(); plan.events], ..Self::default() };
        let stop = record.fill(motion, plan, watch).err();
        (record, stop)
    }

    fn fill<const N: usize>(
        &mut self,
        motion: &mut dyn Motion<N>,
        plan: &Plan<'_>,
        watch: &Watch<'_>,
    ) -> Result<(), Stop> {
        let (every, mut times) = match plan.recorded {
            Recorded::Every(every) => (Some(every.max(1)), [].as_slice()),
            Recorded::At(times) => (None, times),
        };
        let records = every.map_or(times.len() as u64, |every| plan.steps.div_ceil(every).saturating_add(1));
        self.reserve(motion, records).map_err(Stop::TooLarge)?;
        if every.is_some() {
            self.push(motion, plan)?;
        }
        self.push_reached(&mut times, motion, plan)?;
        let far = |taken: u64| Some((taken, plan.steps.max(taken)));
        while plan.ends_by_itself || self.steps < plan.steps {
            match motion.advance() {
                Some(Ok(Watched::Step(step))) => self.iterations += u64::from(step.report.iterations),
                Some(Ok(Watched::Event(event))) => {
                    if let Some(found) = self.events.get_mut(event.index) {
                        found.add(plan.origin, &event);
                    }
                    continue;
                }
                Some(Err(EventError::Step(error))) => return Err(self.failed(motion, plan, error)),
                Some(Err(error)) => return Err(Stop::Events(error)),
                None => {
                    self.push_reached(&mut times, motion, plan)?;
                    // The run has ended between two records, by an event or at a time.
                    if every.is_some() && self.t.last() != Some(&(plan.origin + motion.time())) {
                        self.push(motion, plan)?;
                    }
                    break;
                }
            }
            self.steps += 1;
            let is_last = self.steps == plan.steps && !plan.ends_by_itself;
            let is_due = |every| self.steps.is_multiple_of(every) || is_last;
            if every.is_some_and(is_due) {
                self.push(motion, plan)?;
            }
            self.push_reached(&mut times, motion, plan)?;
            if self.steps.is_multiple_of(Told::STRIDE) && watch.pass(far(self.steps)).is_break() {
                return Err(Stop::Interrupted);
            }
        }
        if watch.tell(far(self.steps)).is_break() { Err(Stop::Interrupted) } else { Ok(()) }
    }

    /// Records the states at those of `times` that the run has reached, and takes these away.
    fn push_reached<const N: usize>(
        &mut self,
        times: &mut &[Timed],
        motion: &dyn Motion<N>,
        plan: &Plan<'_>,
    ) -> Result<(), Stop> {
        while let Some((&Timed { time, elapsed }, later)) = times.split_first()
            && let Some(at) = motion.at(elapsed)
        {
            let At { state, v, energy } = at.map_err(|error| self.failed(motion, plan, error))?;
            self.add(time, &state, &v, energy);
            *times = later;
        }
        Ok(())
    }

    fn add<const N: usize>(&mut self, time: f64, state: &State<f64, N>, v: &SVector<f64, N>, energy: f64) {
        self.t.push(time);
        self.q.extend_from_slice(state.q.as_slice());
        self.v.extend_from_slice(v.as_slice());
        self.p.extend_from_slice(state.p.as_slice());
        self.energy.push(energy);
    }

    fn reserve<const N: usize>(
        &mut self,
        motion: &dyn Motion<N>,
        records: u64,
    ) -> Result<(), TryReserveError> {
        let records = usize::try_from(records).unwrap_or(usize::MAX);
        let of = |numbers: usize| records.saturating_mul(numbers);
        self.t.try_reserve_exact(records)?;
        for vectors in [&mut self.q, &mut self.v, &mut self.p] {
            vectors.try_reserve_exact(of(N))?;
        }
        self.energy.try_reserve_exact(records)?;
        if let Some(dependence) = motion.dependence() {
            self.by_start.try_reserve_exact(of(4 * N * N))?;
            self.by_parameters.try_reserve_exact(of(2 * N * dependence.by_parameters.len()))?;
        }
        Ok(())
    }

    fn push<const N: usize>(&mut self, motion: &dyn Motion<N>, plan: &Plan<'_>) -> Result<(), Stop> {
        let (v, energy) = motion.measured().map_err(|error| self.failed(motion, plan, error))?;
        let reactions = motion.reactions().map_err(|error| self.failed(motion, plan, error))?;
        self.reactions.extend(reactions);
        self.add(plan.origin + motion.time(), motion.state(), &v, energy);
        if let Some(dependence) = motion.dependence() {
            self.by_start.extend(matrix_rows(&dependence.by_start));
            self.by_parameters.extend(column_rows(&dependence.by_parameters));
        }
        Ok(())
    }

    fn failed<const N: usize>(&self, motion: &dyn Motion<N>, plan: &Plan<'_>, error: StepError) -> Stop {
        let state = motion.state();
        let state = [state.q, state.p].map(|vector| vector.as_slice().to_vec());
        Stop::Failed(Failure { error, step: self.steps, time: plan.origin + motion.time(), state })
    }
}
