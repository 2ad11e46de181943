//! Runs that are looked at between their steps.

use dalembert::nalgebra::SVector;
use dalembert::run::Run;
use dalembert::run::between::{Dense, Divisible, TimeError};
use dalembert::run::events::{EventError, Watched as Next};
use dalembert::step::Step;
use dalembert::{Lagrangian, State, StepError};

use crate::motion::{At, Motion, measured};

/// A step of a run, or why it could not be taken.
pub(crate) type Taken<const N: usize> = Result<Step<f64, N>, StepError>;

/// A run by some method: looking into it is compiled for a system, not for each of its methods.
pub(crate) type BySome<'r, L, const N: usize> =
    dyn Divisible<N, Item = Taken<N>, Scalar = f64, System = L> + 'r;

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

/// A run that is looked at between its steps, while it is recorded.
pub(crate) struct Looking<'t, 'r, L: Lagrangian<N, Scalar = f64>, const N: usize> {
    pub(crate) dense: Dense<'t, BySome<'r, L, N>, N>,
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
