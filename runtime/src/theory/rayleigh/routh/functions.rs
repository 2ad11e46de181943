//! The discrete Rayleigh system that is left: L̂⁺ and L̂⁻.

use nalgebra::SVector;

use super::coordinates::with;
use crate::step::{DiscreteRayleigh, Segment};
use crate::theory::rayleigh::routh::{Routh, RouthError};

/// The functions of the reduced system.
impl<L, R, const N: usize, const K: usize> Routh<'_, L, R, N, K>
where
    L: DiscreteRayleigh<R, N>,
{
    /// L_d^± on the segment, with μ and Δ.
    fn modified(
        &self,
        x0: &SVector<L::Scalar, K>,
        x1: &SVector<L::Scalar, K>,
        momentum: L::Scalar,
    ) -> Result<[L::Scalar; 3], RouthError> {
        let (system, h, theta) = (self.by.system(), self.by.step_size(), self.cyclic);
        let found = self.segment(x0, &((x1 - x0) / h), momentum, nalgebra::zero());
        let (_, rate) = found.map_err(RouthError::NoAngle)?;
        let (q0, q1) = (with(x0, nalgebra::zero(), theta), with(x1, rate * h, theta));
        let segment = Segment::between(&q0, &q1, h);
        Ok([system.modified_plus(&segment), system.modified_minus(&segment), rate * h])
    }

    /// L̂⁺(x0, x1; μ) = L_d⁺ − μΔ.
    ///
    /// # Errors
    /// [`RouthError::NoAngle`] where no Δ has the momentum μ.
    pub fn modified_plus(
        &self,
        x0: &SVector<L::Scalar, K>,
        x1: &SVector<L::Scalar, K>,
        momentum: L::Scalar,
    ) -> Result<L::Scalar, RouthError> {
        let [plus, _, angle] = self.modified(x0, x1, momentum)?;
        Ok(plus - momentum * angle)
    }

    /// L̂⁻(x0, x1; μ) = L_d⁻ − g(μ)Δ.
    ///
    /// # Errors
    /// [`RouthError::NoAngle`] where no Δ has the momentum μ.
    pub fn modified_minus(
        &self,
        x0: &SVector<L::Scalar, K>,
        x1: &SVector<L::Scalar, K>,
        momentum: L::Scalar,
    ) -> Result<L::Scalar, RouthError> {
        let [_, minus, angle] = self.modified(x0, x1, momentum)?;
        Ok(minus - self.next_momentum(momentum)? * angle)
    }
}
