//! Runs that are looked at between their steps, and that end at a time.

use dalembert::nalgebra::SVector;
use dalembert::run::Run;
use dalembert::run::between::{Dense, Divisible, LastStep, Restartable, TimeError};
use dalembert::run::events::{EventError, Watched as Next};
use dalembert::step::Step;
use dalembert::{Lagrangian, State, StepError};

use crate::events::{Events, watched};
use crate::motion::{Motion, measured};

/// A step of a run, or why it could not be taken.
type Taken<const N: usize> = Result<Step<f64, N>, StepError>;

/// A run by some method: looking into it is compiled for a system, not for each of its methods.
pub(crate) type BySome<'r, L, const N: usize> =
    dyn Divisible<N, Item = Taken<N>, Scalar = f64, System = L> + 'r;

/// A run by some method that can end at a time.
pub(crate) type EndingBySome<'r, L, const N: usize> =
    dyn Restartable<N, Item = Taken<N>, Scalar = f64, System = L> + 'r;

/// What is asked of a run besides the states at the ends of its steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Look<'a> {
    /// The events to look for.
    pub events: Option<Events<'a>>,
    /// Whether states between the steps are asked for.
    pub is_dense: bool,
    /// The time from the start at which it ends, where that is no whole number of steps.
    pub end: Option<f64>,
}

impl Look<'_> {
    /// Whether anything is.
    #[must_use]
    pub fn is_any(&self) -> bool {
        self.events.is_some() || self.is_dense || self.end.is_some()
    }
}

/// A state between the steps, with its velocity and energy.
#[derive(Clone, Copy, Debug)]
pub struct At<const N: usize> {
    /// The state.
    pub state: State<f64, N>,
    /// Its velocity.
    pub v: SVector<f64, N>,
    /// Its energy.
    pub energy: f64,
}

/// The state of a run at a time, by a step as long as it takes to there; `None` where it has not come so far.
pub(crate) fn looked_at<T, const N: usize>(
    dense: &Dense<'_, T, N>,
    time: f64,
) -> Option<Result<At<N>, StepError>>
where
    T: Divisible<N, Scalar = f64> + ?Sized,
{
    if !dense.has_reached(time) {
        return None;
    }
    let state = match dense.state_at(time) {
        Ok(state) => state,
        Err(TimeError::Step(error)) => return Some(Err(error)),
        // A time before the last step, which was not asked for when it was reached.
        Err(_) => return None,
    };
    let run = dense.run();
    let measured = run.system().later(time - run.since(), |system| measured(system, &state));
    Some(measured.map(|(v, energy)| At { state, v, energy }))
}

/// Records `run` while it is looked into, up to the end that is asked for.
pub(crate) fn looked_into<L, const N: usize>(
    run: &mut EndingBySome<'_, L, N>,
    look: Look<'_>,
    record: &mut dyn FnMut(&mut dyn Motion<N>),
) where
    L: Lagrangian<N, Scalar = f64>,
{
    match look.end {
        Some(end) => {
            let size = Divisible::step_size(run);
            seen(&mut Ending { run, end, size }, look.events, record);
        }
        None => seen(run, look.events, record),
    }
}

/// Records `run` while it is looked into, for events too where they are asked for.
pub(crate) fn seen<L, const N: usize>(
    run: &mut BySome<'_, L, N>,
    events: Option<Events<'_>>,
    record: &mut dyn FnMut(&mut dyn Motion<N>),
) where
    L: Lagrangian<N, Scalar = f64>,
{
    match events {
        Some(events) => watched(run, events, record),
        None => record(&mut Looking { dense: Dense::new(run) }),
    }
}

/// A run that ends at a time, as any other run that can be looked into.
struct Ending<'t, 'r, L: Lagrangian<N, Scalar = f64>, const N: usize> {
    run: &'t mut EndingBySome<'r, L, N>,
    end: f64,
    /// The size of the last step, of the next one at the start.
    size: f64,
}

impl<L: Lagrangian<N, Scalar = f64>, const N: usize> Iterator for Ending<'_, '_, L, N> {
    type Item = Taken<N>;

    fn next(&mut self) -> Option<Taken<N>> {
        let taken = self.run.next_until(self.end)?;
        Some(taken.map(|(step, size)| {
            self.size = size;
            step
        }))
    }
}

impl<L: Lagrangian<N, Scalar = f64>, const N: usize> Run<N> for Ending<'_, '_, L, N> {
    type Scalar = f64;

    fn state(&self) -> &State<f64, N> {
        Run::state(self.run)
    }

    fn time(&self) -> f64 {
        Run::time(self.run)
    }
}

impl<L: Lagrangian<N, Scalar = f64>, const N: usize> Divisible<N> for Ending<'_, '_, L, N> {
    type System = L;

    fn system(&self) -> &L {
        Divisible::system(self.run)
    }

    fn since(&self) -> f64 {
        Divisible::since(self.run)
    }

    fn step_size(&self) -> f64 {
        self.size
    }

    fn last_step(&self) -> &dyn LastStep<L, N> {
        Divisible::last_step(self.run)
    }
}

/// A run that is looked at between its steps, while it is recorded.
struct Looking<'t, 'r, L: Lagrangian<N, Scalar = f64>, const N: usize> {
    dense: Dense<'t, BySome<'r, L, N>, N>,
}

impl<L: Lagrangian<N, Scalar = f64>, const N: usize> Motion<N> for Looking<'_, '_, L, N> {
    fn advance(&mut self) -> Option<Result<Next<f64, N>, EventError>> {
        self.dense.next().map(|step| step.map(Next::Step).map_err(EventError::from))
    }

    fn state(&self) -> &State<f64, N> {
        Run::state(self.dense.run())
    }

    fn time(&self) -> f64 {
        Run::time(self.dense.run())
    }

    fn measured(&self) -> Result<(SVector<f64, N>, f64), StepError> {
        let run = self.dense.run();
        run.system().later(Run::time(run) - run.since(), |system| measured(system, Run::state(run)))
    }

    fn at(&self, time: f64) -> Option<Result<At<N>, StepError>> {
        looked_at(&self.dense, time)
    }
}
