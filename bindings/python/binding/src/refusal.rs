//! Why a call does nothing.

use dalembert::StepError;
use dalembert::samples::SampleError;
use dalembert::tolerance::ToleranceError;

/// A step that failed, and where the run stands.
#[derive(Clone, Debug)]
pub struct Failure {
    /// Why.
    pub error: StepError,
    /// The step, counted from 0.
    pub step: u64,
    /// The time of the last good state.
    pub time: f64,
    /// Its configuration and momentum; no momentum where the start is no state.
    pub state: [Vec<f64>; 2],
}

/// Why there is not even the beginning of a run.
#[derive(Clone, Debug)]
pub enum Refusal {
    /// There is no such rule.
    Rule,
    /// The rule's steps take no changing inputs and have no derivatives.
    NotDriven,
    /// Events are those of runs that hold one input, without derivatives.
    NotWatched,
    /// The rule has no discrete objects by formulas.
    NotChecked,
    /// Constraints of velocity leave no discrete Lagrangian to be asked for symmetries.
    NotHolonomic,
    /// The samples say nothing.
    Samples(SampleError),
    /// Of this system no error can be asked.
    NoError,
    /// No method reaches the error.
    Tolerance(ToleranceError),
    /// The start is no state, or the step from it fails.
    Start(Failure),
    /// Its watcher has called it off before there was anything.
    CalledOff,
}

impl From<SampleError> for Refusal {
    fn from(error: SampleError) -> Self {
        match error {
            SampleError::Stopped => Self::CalledOff,
            error => Self::Samples(error),
        }
    }
}

impl From<ToleranceError> for Refusal {
    fn from(error: ToleranceError) -> Self {
        match error {
            ToleranceError::Stopped => Self::CalledOff,
            error => Self::Tolerance(error),
        }
    }
}
