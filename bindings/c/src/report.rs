//! How a step went, how far a state is off its constraints, and which point of a table is wrong, as C reads
//! it.

use core::ffi::c_char;
use core::ptr;

use dalembert::step::Report;
use dalembert::system::{Scalar, Violation};
use dalembert_face::{Field, WrongPoints};

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

/// The first table whose points make none: `struct dalembert_wrong_point` of the header. See
/// [`TableError`](dalembert::system::TableError).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct CWrongPoint {
    /// The name of the field, ended by a zero byte; NULL where all tables are right.
    pub table: *const c_char,
    /// A status of tables, or [`Status::Ok`].
    pub status: i32,
    /// Which point, from 0; 0 where none is wrong by itself.
    pub point: u32,
}

impl CWrongPoint {
    /// The one that was found among these fields, if any.
    #[must_use]
    pub fn new(fields: &[Field], found: Option<WrongPoints>) -> Self {
        let Some(wrong) = found else {
            return Self { table: ptr::null(), status: Status::Ok as i32, point: 0 };
        };
        let table = fields.get(wrong.field).map_or(ptr::null(), |field| field.name_for_c.as_ptr());
        let point = wrong.error.point().unwrap_or(0) as u32;
        Self { table, status: Status::from(wrong) as i32, point }
    }
}
