//! Long runs that keep figures instead of states.

use dalembert::step::Flow;
use dalembert::{Discrete, Discretise, State, StepError, Trajectory};

/// What a run took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    /// Steps taken.
    pub steps: u64,
    /// Newton iterations, all steps together.
    pub iterations: u64,
    /// Steps whose Newton step had to be shortened.
    pub damped: u64,
    /// Largest residual, in units of its round-off floor.
    pub worst_residual: f64,
    /// Why it stopped before its end.
    pub stopped: Option<StepError>,
}

/// A state on the way.
#[derive(Clone, Copy, Debug)]
pub struct Progress<const N: usize> {
    /// Steps taken so far.
    pub steps: u64,
    /// The time.
    pub time: f64,
    /// The state.
    pub state: State<f64, N>,
}

/// Takes `steps` steps and shows every `stride`-th state to `look`; the first error ends the run and is
/// returned with it.
pub fn drive<S, R, const N: usize>(
    system: &S,
    rule: R,
    h: f64,
    start: State<f64, N>,
    [steps, stride]: [u64; 2],
    mut look: impl FnMut(Progress<N>),
) -> Effort
where
    S: Discrete<R, N, Scalar = f64>,
{
    let mut effort = Effort::default();
    let mut trajectory = system.by(rule, h).run(start);
    for sample in trajectory.sample_every(stride).take((steps / stride) as usize) {
        match sample {
            Ok(sample) => {
                effort.steps += stride;
                effort.iterations += sample.iterations;
                effort.damped += sample.damped;
                effort.worst_residual = effort.worst_residual.max(sample.worst_residual);
                look(Progress { steps: effort.steps, time: sample.time, state: sample.state });
            }
            Err(error) => effort.stopped = Some(error),
        }
    }
    effort
}

/// The same by a composition or a splitting, every state of it, without a count of iterations.
pub fn drive_composed<L, M, const N: usize>(
    mut trajectory: Trajectory<'_, L, M, N>,
    steps: u64,
    mut look: impl FnMut(Progress<N>),
) -> Effort
where
    L: Flow<M, N, Scalar = f64>,
{
    let mut effort = Effort::default();
    for _ in 0..steps {
        match trajectory.next() {
            Some(Ok(step)) => {
                effort.steps += 1;
                look(Progress { steps: effort.steps, time: trajectory.time(), state: step.state });
            }
            Some(Err(error)) => effort.stopped = Some(error),
            None => break,
        }
    }
    effort
}
