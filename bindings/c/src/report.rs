//! How a step went, and how far a state is off its constraints, as C reads it.

use dalembert::step::Report;
use dalembert::system::{Scalar, Violation};

use crate::Status;

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

/// The first constraint that a state violates: `struct dalembert_violation` of the header. See
/// [`dalembert::system::Violation`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct CViolation {
    /// The value of the constraint, in its unit, or its rate, in that per unit of time; NaN where it has no
    /// derivative.
    pub amount: f64,
    /// [`Status::OffConstraint`], [`Status::LeavesConstraint`], [`Status::NoDerivativeOfConstraint`], or
    /// [`Status::Ok`] where none is violated.
    pub status: i32,
    /// Which one, from 0.
    pub constraint: u32,
}

impl From<Option<Violation>> for CViolation {
    fn from(found: Option<Violation>) -> Self {
        let (status, constraint, amount) = match found {
            None => (Status::Ok, 0, 0.0),
            Some(Violation::NoDerivative { constraint, .. }) => {
                (Status::NoDerivativeOfConstraint, constraint, f64::NAN)
            }
            Some(Violation::Off { constraint, value }) => (Status::OffConstraint, constraint, value),
            Some(Violation::Leaving { constraint, rate }) => (Status::LeavesConstraint, constraint, rate),
        };
        Self { amount, status: status as i32, constraint: constraint as u32 }
    }
}
