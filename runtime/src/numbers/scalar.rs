//! The scalar type of a system: `f64` or `f32`.

use nalgebra::RealField;

use crate::numbers::{Functions, Vectors};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for f32 {}
}

/// The scalar type that a system is written in: `f64` or `f32`.
///
/// Sealed: tolerances are derived from [`EPSILON`](Scalar::EPSILON) and hold for IEEE formats only.
pub trait Scalar: RealField + Copy + Functions + Vectors + sealed::Sealed {
    /// Distance from 1 to the next larger number.
    const EPSILON: Self;

    /// The smallest positive number that carries all its digits.
    const SMALLEST_NORMAL: Self;

    /// The nearest scalar to an `f64` constant.
    fn constant(value: f64) -> Self;

    /// This number in `f64`, exact for both types.
    fn widen(self) -> f64;
}

impl Scalar for f64 {
    const EPSILON: Self = f64::EPSILON;
    const SMALLEST_NORMAL: Self = f64::MIN_POSITIVE;

    #[inline]
    fn constant(value: f64) -> Self {
        value
    }

    #[inline]
    fn widen(self) -> f64 {
        self
    }
}

impl Scalar for f32 {
    const EPSILON: Self = f32::EPSILON;
    const SMALLEST_NORMAL: Self = f32::MIN_POSITIVE;

    #[inline]
    fn constant(value: f64) -> Self {
        value as f32
    }

    #[inline]
    fn widen(self) -> f64 {
        f64::from(self)
    }
}
