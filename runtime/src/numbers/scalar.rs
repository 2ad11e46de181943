//! The scalar type of a system: `f64` or `f32`.

use crate::numbers::{Functions, Precision, Vectors, comparison::Compares, nonlinear::AtLength};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for f32 {}
}

/// The scalar type that a system is written in: `f64` or `f32`.
///
/// Sealed: tolerances are derived from [`EPSILON`](Scalar::EPSILON) and hold for IEEE formats only.
pub trait Scalar: Precision + Functions + Vectors + AtLength + Compares + sealed::Sealed {
    /// Distance from 1 to the next larger number.
    const EPSILON: Self = Self::SPACING;

    /// The smallest positive number that carries all its digits.
    const SMALLEST_NORMAL: Self = Self::LEAST_NORMAL;

    /// The nearest scalar to an `f64` constant.
    #[inline]
    fn constant(value: f64) -> Self {
        Self::nearest(value)
    }

    /// This number in `f64`, exact for both types.
    #[inline]
    fn widen(self) -> f64 {
        self.widened()
    }
}

impl Scalar for f64 {}
impl Scalar for f32 {}
