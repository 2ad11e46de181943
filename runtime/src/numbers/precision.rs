//! The precision of a type of real numbers.

use nalgebra::RealField;

/// The precision of a type of real numbers in an IEEE format.
///
/// [`Scalar`](crate::numbers::Scalar) shows it; this is what the floor below it knows.
pub trait Precision: RealField + Copy {
    /// Distance from 1 to the next larger number.
    const SPACING: Self;

    /// The smallest positive number that carries all its digits.
    const LEAST_NORMAL: Self;

    /// The nearest number to an `f64`.
    fn nearest(value: f64) -> Self;

    /// This number in `f64`, exact for both types.
    fn widened(self) -> f64;
}

impl Precision for f64 {
    const SPACING: Self = f64::EPSILON;
    const LEAST_NORMAL: Self = f64::MIN_POSITIVE;

    #[inline]
    fn nearest(value: f64) -> Self {
        value
    }

    #[inline]
    fn widened(self) -> f64 {
        self
    }
}

impl Precision for f32 {
    const SPACING: Self = f32::EPSILON;
    const LEAST_NORMAL: Self = f32::MIN_POSITIVE;

    #[inline]
    fn nearest(value: f64) -> Self {
        value as f32
    }

    #[inline]
    fn widened(self) -> f64 {
        f64::from(self)
    }
}
