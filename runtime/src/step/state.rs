//! A point of T*Q.

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::StepError;
use crate::system::Quantity;

/// Configuration and momentum, a point (q, p) of T*Q.
///
/// Made from (q, v) by [`State::from_velocity`], or from two configurations by
/// [`legendre_plus`](crate::step::DiscreteSegment::legendre_plus) (the state at q1) and
/// [`legendre_minus`](crate::step::DiscreteSegment::legendre_minus) (the state at q0).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "S: Scalar + serde::Serialize",
        deserialize = "S: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct State<S, const N: usize> {
    /// Configuration.
    pub q: SVector<S, N>,
    /// Momentum, in units of ∂L/∂v.
    pub p: SVector<S, N>,
}

impl<S: Scalar, const N: usize> State<S, N> {
    /// Fails with the first entry of q or p that is not finite.
    #[inline]
    pub(crate) fn require_finite(&self) -> Result<(), StepError> {
        StepError::require_finite(&self.q, Quantity::Configuration)?;
        StepError::require_finite(&self.p, Quantity::Momentum)
    }

    /// Likewise of the state that a step leads to.
    #[inline]
    pub(crate) fn require_reached(&self) -> Result<(), StepError> {
        self.require_finite().map_err(StepError::of_reached)
    }
}
