//! The records of a run.

use std::collections::TryReserveError;

use dalembert::StepError;
use dalembert::run::Stop as Told;
use dalembert::run::events::{EventError, Watched};
use dalembert::tolerance::Breach;

use crate::derivatives::{column_rows, matrix_rows};
use crate::events::Found;
use crate::motion::Motion;
pub use crate::refusal::Failure;
use crate::watch::Watch;

/// Which steps are recorded, of how many.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Steps in all.
    pub steps: u64,
    /// Steps from one record to the next; the last one is recorded as well.
    pub every: u64,
    /// The time at the start.
    pub origin: f64,
    /// Event functions.
    pub events: usize,
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
        plan: &Plan,
        watch: &Watch<'_>,
    ) -> (Self, Option<Stop>) {
        let mut record = Self { events: vec![Found::default(); plan.events], ..Self::default() };
        let stop = record.fill(motion, plan, watch).err();
        (record, stop)
    }

    fn fill<const N: usize>(
        &mut self,
        motion: &mut dyn Motion<N>,
        plan: &Plan,
        watch: &Watch<'_>,
    ) -> Result<(), Stop> {
        let every = plan.every.max(1);
        self.reserve(motion, plan.steps.div_ceil(every).saturating_add(1)).map_err(Stop::TooLarge)?;
        self.push(motion, plan)?;
        let far = |taken| Some((taken, plan.steps));
        while self.steps < plan.steps {
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
                    // An event has ended the run between two records.
                    if self.t.last() != Some(&(plan.origin + motion.time())) {
                        self.push(motion, plan)?;
                    }
                    break;
                }
            }
            self.steps += 1;
            if self.steps.is_multiple_of(every) || self.steps == plan.steps {
                self.push(motion, plan)?;
            }
            if self.steps.is_multiple_of(Told::STRIDE) && watch.pass(far(self.steps)).is_break() {
                return Err(Stop::Interrupted);
            }
        }
        if watch.tell(far(self.steps)).is_break() { Err(Stop::Interrupted) } else { Ok(()) }
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

    fn push<const N: usize>(&mut self, motion: &dyn Motion<N>, plan: &Plan) -> Result<(), Stop> {
        let (v, energy) = motion.measured().map_err(|error| self.failed(motion, plan, error))?;
        let reactions = motion.reactions().map_err(|error| self.failed(motion, plan, error))?;
        let state = motion.state();
        self.reactions.extend(reactions);
        self.t.push(plan.origin + motion.time());
        self.q.extend_from_slice(state.q.as_slice());
        self.v.extend_from_slice(v.as_slice());
        self.p.extend_from_slice(state.p.as_slice());
        self.energy.push(energy);
        if let Some(dependence) = motion.dependence() {
            self.by_start.extend(matrix_rows(&dependence.by_start));
            self.by_parameters.extend(column_rows(&dependence.by_parameters));
        }
        Ok(())
    }

    fn failed<const N: usize>(&self, motion: &dyn Motion<N>, plan: &Plan, error: StepError) -> Stop {
        let state = motion.state();
        let state = [state.q, state.p].map(|vector| vector.as_slice().to_vec());
        Stop::Failed(Failure { error, step: self.steps, time: plan.origin + motion.time(), state })
    }
}
