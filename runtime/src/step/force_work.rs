//! The energy that forces take from a system and bring to it over one step.

use core::ops::{Add, Mul};

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::{Flow, State, StepError};
use crate::system::ActingForce;

/// The energy that forces took and brought over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyExchange<S> {
    /// ∫ v·∂R/∂v dt, what friction took.
    pub dissipated: S,
    /// ∫ v·f dt, what the general force brought.
    pub work: S,
}

impl<S: Scalar> EnergyExchange<S> {
    /// No energy taken and no energy brought.
    #[must_use]
    pub fn zero() -> Self {
        Self { dissipated: S::zero(), work: S::zero() }
    }

    /// The powers v·∂R/∂v and v·f at (q, v): times a weight, a term of a quadrature.
    #[must_use]
    pub fn power<L: ActingForce<N, Scalar = S>, const N: usize>(
        system: &L,
        q: &SVector<S, N>,
        v: &SVector<S, N>,
    ) -> Self {
        Self {
            dissipated: if L::HAS_RAYLEIGH { v.dot(&system.dissipation(q, v).d2) } else { S::zero() },
            work: if L::HAS_FORCE { v.dot(&system.general_force(q, v)) } else { S::zero() },
        }
    }
}

impl<S: Scalar> Add for EnergyExchange<S> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { dissipated: self.dissipated + other.dissipated, work: self.work + other.work }
    }
}

impl<S: Scalar> Mul<S> for EnergyExchange<S> {
    type Output = Self;
    fn mul(self, factor: S) -> Self {
        Self { dissipated: self.dissipated * factor, work: self.work * factor }
    }
}

/// A method that tells what forces took and brought over its steps, where it sees them itself: by the rule's
/// own quadrature Σ bᵢ Vᵢ·∂R/∂v(Qᵢ, Vᵢ), exactly where it solves a part of the motion exactly.
#[diagnostic::on_unimplemented(
    message = "`{M}` does not tell what forces did over a step of `{Self}`",
    label = "no account of the energy by `{M}`",
    note = "a system whose force takes an input or the time has one as a view: `system.driven(u)`, `system.at_time(t)`",
    note = "of a step that was made otherwise, `EnergyLedger::of` takes account from its two ends"
)]
pub trait ForceWork<M, const N: usize>: Flow<M, N> + ActingForce<N> {
    /// The energy that forces took and brought over the step of size `h` from `from` to `to`.
    ///
    /// A method with points between the ends makes the step again from `from`.
    ///
    /// # Errors
    /// Those of [`Flow::step`].
    fn energy_exchange(
        &self,
        from: &State<Self::Scalar, N>,
        to: &State<Self::Scalar, N>,
        h: Self::Scalar,
    ) -> Result<EnergyExchange<Self::Scalar>, StepError>;
}
