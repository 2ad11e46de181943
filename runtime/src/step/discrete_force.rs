//! The discrete force as data.

use nalgebra::SVector;

use crate::numbers::{CovectorDerivatives, Derivatives, Scalar, derivatives::linear};

/// The discrete force f_d = (f_d⁻, f_d⁺): covectors at q0 and at q1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscreteForce<S, const N: usize> {
    /// f_d⁻(q0, q1), at q0.
    pub minus: SVector<S, N>,
    /// f_d⁺(q0, q1), at q1.
    pub plus: SVector<S, N>,
}

/// The discrete force with its derivatives by q0 (`d1`) and q1 (`d2`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiscreteForceDerivatives<S, const N: usize> {
    /// f_d⁻, D1 f_d⁻, D2 f_d⁻.
    pub minus: CovectorDerivatives<S, N>,
    /// f_d⁺, D1 f_d⁺, D2 f_d⁺.
    pub plus: CovectorDerivatives<S, N>,
}

linear!(DiscreteForce { minus, plus });

impl<S: Scalar, const N: usize> DiscreteForceDerivatives<S, N> {
    /// Zero in every field.
    #[inline]
    #[must_use]
    pub fn zero() -> Self {
        Self { minus: CovectorDerivatives::zero(), plus: CovectorDerivatives::zero() }
    }

    /// f_d⁻ = D1 R_d and f_d⁺ = −D2 R_d.
    #[inline]
    pub(crate) fn of_rayleigh(r: &Derivatives<S, N>) -> Self {
        Self {
            minus: CovectorDerivatives { value: r.d1, d1: r.d11, d2: r.d12 },
            plus: CovectorDerivatives { value: -r.d2, d1: -r.d12.transpose(), d2: -r.d22 },
        }
    }

    /// The derivatives of the R_d with this force, and its `value`.
    #[inline]
    pub(crate) fn as_of_rayleigh(&self, value: S) -> Derivatives<S, N> {
        let Self { minus, plus } = self;
        Derivatives { value, d1: minus.value, d2: -plus.value, d11: minus.d1, d12: minus.d2, d22: -plus.d2 }
    }
}

impl<S: Scalar, const N: usize> core::ops::Add for DiscreteForceDerivatives<S, N> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { minus: self.minus + other.minus, plus: self.plus + other.plus }
    }
}
