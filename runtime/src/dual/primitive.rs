//! The elementary functions of `f64` and `f32` that the dual engine evaluates itself.

use num_dual::DualNumFloat;

use super::Dual;
use crate::Scalar;

/// A plain scalar with its elementary functions, those of the standard library.
pub trait Primitive: Scalar + DualNumFloat + Dual<Self> {
    /// Tangent.
    fn tan(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// eˣ.
    fn exp(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Cube root.
    fn cbrt(self) -> Self;
    /// |x|.
    fn abs(self) -> Self;
    /// ±1 by the sign bit, NaN for NaN.
    fn signum(self) -> Self;
    /// xⁿ, n an integer.
    fn powi(self, n: i32) -> Self;
    /// xⁿ, n a real number.
    fn powf(self, n: Self) -> Self;
    /// Angle of the point (x, self).
    fn atan2(self, x: Self) -> Self;
    /// √(self² + y²).
    fn hypot(self, y: Self) -> Self;
    /// Whether it is NaN.
    fn is_nan(self) -> bool;
    /// Whether it is finite.
    fn is_finite(self) -> bool;
    /// Whether the sign bit is set.
    fn is_sign_negative(self) -> bool;
}

macro_rules! primitive {
    ($($float:ident)*) => {$(
        impl Primitive for $float {
            primitive!($float: tan() tanh() exp() sqrt() cbrt() abs() signum() powi(n: i32) powf(n: $float)
                atan2(x: $float) hypot(y: $float) => $float);
            primitive!($float: is_nan() is_finite() is_sign_negative() => bool);
        }
    )*};
    ($float:ident: $($name:ident($($argument:ident: $type:ty)?))* => $output:ty) => {$(
        #[inline]
        fn $name(self $(, $argument: $type)?) -> $output {
            $float::$name(self $(, $argument)?)
        }
    )*};
}
primitive!(f64 f32);
