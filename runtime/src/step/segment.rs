//! A segment of a motion: where it starts, its mean velocity, and how long it takes.

use nalgebra::SVector;

use crate::numbers::Scalar;

/// A segment of a motion: from q0 with the mean velocity v̄ over a step of size h, to q1 = q0 + h v̄.
///
/// L_d, f_d, both momenta and their derivatives are functions of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<S, const N: usize> {
    /// The configuration at the start.
    pub q0: SVector<S, N>,
    /// The mean velocity v̄ = (q1 − q0)/h.
    pub v: SVector<S, N>,
    /// The step size.
    pub h: S,
}

impl<S: Scalar, const N: usize> Segment<S, N> {
    /// The segment from `q0` to `q1` in a step of size `h`.
    #[inline]
    pub fn between(q0: &SVector<S, N>, q1: &SVector<S, N>, h: S) -> Self {
        Self { q0: *q0, v: (q1 - q0) / h, h }
    }

    /// The configuration after this `share` of the segment.
    #[inline]
    #[must_use]
    pub fn at(&self, share: S) -> SVector<S, N> {
        self.q0 + self.v * (share * self.h)
    }

    /// The configuration at the end, q1 = q0 + h v̄.
    #[inline]
    #[must_use]
    pub fn end(&self) -> SVector<S, N> {
        self.q0 + self.v * self.h
    }
}
