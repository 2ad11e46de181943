//! The cause of derivatives that are not finite: which of L, R and f has none, and where.
//!
//! With the standard library errors name it. Without it they do not, and no program carries what finds it
//! unless it asks: [`Lagrangian::without_derivative`].

use nalgebra::SVector;

#[cfg(feature = "std")]
use crate::step::Quantity;
use crate::step::StepError;
use crate::system::{Lagrangian, NoDerivative, missing};

/// The `error`, if it is one of derivatives that are not finite, with its `cause` in place of it.
#[cfg(feature = "std")]
#[cold]
#[inline(never)]
pub(crate) fn explained(error: StepError, cause: &dyn Fn() -> Option<NoDerivative>) -> StepError {
    match error {
        StepError::NonFinite { quantity: Quantity::Derivatives, .. } => {
            cause().map_or(error, StepError::from)
        }
        other => other,
    }
}

/// The `error`: nothing looks for its cause.
#[cfg(not(feature = "std"))]
#[inline(always)]
pub(crate) fn explained(error: StepError, _: &dyn Fn() -> Option<NoDerivative>) -> StepError {
    error
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
    explained(error, &|| missing::lagrangian(system, q, v))
}
