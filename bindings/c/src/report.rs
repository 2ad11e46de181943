//! How a step went, as C reads it.

use dalembert::step::Report;
use dalembert::system::Scalar;

/// How a step went: `struct dalembert_report` of the header. See [`dalembert::step::Report`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct CReport {
    /// The time after the step.
    pub time: f64,
    /// Largest residual of the step's equation, against its floor.
    pub residual: f64,
    /// The round-off floor of that residual.
    pub floor: f64,
    /// Iterations of the solver.
    pub iterations: u32,
    /// Iterations that had to be shortened.
    pub damped: u32,
}

impl CReport {
    /// Of a step that ended at `time`.
    #[must_use]
    pub fn new<S: Scalar>(report: &Report<S>, time: f64) -> Self {
        Self {
            time,
            residual: report.residual.widen(),
            floor: report.floor.widen(),
            iterations: report.iterations,
            damped: report.damped,
        }
    }
}
