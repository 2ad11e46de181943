//! The cause of derivatives that are not finite: which of L, R, f and the constraints has none, and where.
//!
//! With the standard library errors name it. Without it they do not, and no program carries what finds it
//! unless it asks: [`Lagrangian::without_derivative`].

use nalgebra::SVector;

use crate::step::StepError;
use crate::step::regular::is_regular_beside;
#[cfg(feature = "std")]
use crate::system::Quantity;
use crate::system::{Function, Lagrangian, NoDerivative, Violation, missing};

/// The `error`, if it is one of numbers that are not finite, with its `cause` in place of it.
#[cfg(feature = "std")]
#[cold]
#[inline(never)]
pub(crate) fn explained(error: StepError, cause: &dyn Fn() -> Option<StepError>) -> StepError {
    match error {
        StepError::NonFinite { quantity: Quantity::Derivatives, .. } | StepError::Overflow { .. } => {
            cause().unwrap_or(error)
        }
        other => other,
    }
}

/// The `error`: nothing looks for its cause, and no code that would is compiled.
#[cfg(not(feature = "std"))]
#[inline(always)]
pub(crate) fn explained(error: StepError, _: &(impl Fn() -> Option<StepError> + ?Sized)) -> StepError {
    error
}

/// The cause of numbers that are not finite: an operation that has no derivative there, else an input, time
/// or field that is no number, else the function with that derivative.
#[cold]
pub(crate) fn cause_of<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    found: Option<NoDerivative>,
) -> Option<StepError> {
    if let Some(NoDerivative { place: Some(_), .. }) = found {
        return found.map(StepError::from);
    }
    let given = system.non_finite_value();
    given.map(|(quantity, index)| StepError::NonFinite { quantity, index }).or(found.map(StepError::from))
}

/// The error of a point (q, v) that the constraints do not allow.
#[cold]
#[inline(never)]
pub(crate) fn of_violation<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
    violation: Violation,
) -> StepError {
    match violation {
        Violation::NoDerivative { constraint, coordinate } if cfg!(feature = "std") => {
            let function = Function::Constraint { index: constraint };
            let place = system.place_without_derivative(function, q, v);
            let cause = cause_of(system, Some(NoDerivative { function, coordinate, place }));
            cause.unwrap_or(violation.into())
        }
        other => other.into(),
    }
}

/// [`explained`] where L alone was evaluated, at (q, v).
#[cfg_attr(feature = "std", cold)]
#[cfg_attr(not(feature = "std"), inline(always))]
pub(crate) fn explained_by_lagrangian<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
    error: StepError,
) -> StepError {
    let error = explained(error, &|| cause_of(system, missing::lagrangian(system, q, v)));
    match error {
        StepError::DegenerateLagrangian { column } if is_regular_beside(system, q, v) => {
            StepError::SingularCoordinates { column }
        }
        other => other,
    }
}
