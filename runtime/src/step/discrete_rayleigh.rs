//! Discrete systems whose force is that of one function R_d.

use crate::numbers::{Derivatives, Scalar};
use crate::step::{ClosedForm, Discrete, Segment};
use crate::system::Rayleigh;

/// A discrete Rayleigh system: f_d⁻ = D1 R_d, f_d⁺ = −D2 R_d, with L_d⁺ = L_d + R_d and L_d⁻ = L_d − R_d.
///
/// Plus goes with D1 and minus with D2: p0 = −D1 L_d⁺, p1 = D2 L_d⁻ (paper, section 3.3). Where the system
/// has a general force as well, these are the objects of the Rayleigh part alone.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no discrete Rayleigh function by `{R}`",
    label = "this needs R_d, and `{Self}` has none",
    note = "add `fn rayleigh(&self, v: [f64; {N}]) -> f64` to the `#[rayleigh_system]` block; `Discrete` holds all that exists without R"
)]
pub trait DiscreteRayleigh<R, const N: usize>: ClosedForm<R, N> + Discrete<R, N> + Rayleigh<N> {
    /// R_d(q0, q1, h).
    fn discrete_rayleigh(&self, segment: &Segment<Self::Scalar, N>) -> Self::Scalar;

    /// R_d with D1, D2, D11, D12, D22.
    fn discrete_rayleigh_derivatives(
        &self,
        segment: &Segment<Self::Scalar, N>,
    ) -> Derivatives<Self::Scalar, N>;

    /// L_d⁺ = L_d + R_d.
    #[inline]
    fn modified_plus(&self, segment: &Segment<Self::Scalar, N>) -> Self::Scalar {
        self.discrete_lagrangian(segment) + self.discrete_rayleigh(segment)
    }

    /// L_d⁻ = L_d − R_d.
    #[inline]
    fn modified_minus(&self, segment: &Segment<Self::Scalar, N>) -> Self::Scalar {
        self.discrete_lagrangian(segment) - self.discrete_rayleigh(segment)
    }

    /// L_d⁺ with D1, D2, D11, D12, D22.
    #[inline]
    fn modified_plus_derivatives(&self, segment: &Segment<Self::Scalar, N>) -> Derivatives<Self::Scalar, N> {
        self.discrete_lagrangian_derivatives(segment) + self.discrete_rayleigh_derivatives(segment)
    }

    /// L_d⁻ with D1, D2, D11, D12, D22.
    #[inline]
    fn modified_minus_derivatives(&self, segment: &Segment<Self::Scalar, N>) -> Derivatives<Self::Scalar, N> {
        self.discrete_lagrangian_derivatives(segment)
            + self.discrete_rayleigh_derivatives(segment) * -Self::Scalar::constant(1.0)
    }
}
