//! The elementary functions of `f64` and `f32` that the dual engine evaluates itself.

use core::cmp::Ordering;

use num_dual::DualNumFloat;

use super::Dual;
use crate::Scalar;

/// A plain scalar with its elementary functions, those of the standard library.
pub trait Primitive: Scalar + DualNumFloat + Dual<Self> {
    /// 1/x.
    fn recip(self) -> Self;
    /// 2ˣ.
    fn exp2(self) -> Self;
    /// eˣ − 1.
    fn exp_m1(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Logarithm to base 2.
    fn log2(self) -> Self;
    /// Logarithm to base 10.
    fn log10(self) -> Self;
    /// ln(1 + x).
    fn ln_1p(self) -> Self;
    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self);
    /// Arcsine.
    fn asin(self) -> Self;
    /// Arccosine.
    fn acos(self) -> Self;
    /// Arctangent.
    fn atan(self) -> Self;
    /// Hyperbolic sine.
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Inverse hyperbolic sine.
    fn asinh(self) -> Self;
    /// Inverse hyperbolic cosine.
    fn acosh(self) -> Self;
    /// Inverse hyperbolic tangent.
    fn atanh(self) -> Self;
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
    /// self·a + b, rounded once.
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// Half the sum, without overflow on the way.
    fn midpoint(self, other: Self) -> Self;
    /// Degrees to radians.
    fn to_radians(self) -> Self;
    /// Radians to degrees.
    fn to_degrees(self) -> Self;
    /// Order of all numbers, NaN and the two zeros included.
    fn total_cmp(self, other: Self) -> Ordering;
    /// Whether it is neither zero, subnormal, infinite nor NaN.
    fn is_normal(self) -> bool;
    /// Whether it is subnormal.
    fn is_subnormal(self) -> bool;
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
            primitive!($float: recip() exp2() exp_m1() ln() log2() log10() ln_1p() asin() acos() atan() sinh() cosh()
                asinh() acosh() atanh() tan() tanh() exp() sqrt() cbrt() abs() signum() powi(n: i32) powf(n: $float)
                atan2(x: $float) hypot(y: $float) mul_add(a: $float, b: $float) midpoint(other: $float)
                to_radians() to_degrees() => $float);
            primitive!($float: sin_cos() => ($float, $float));
            primitive!($float: is_nan() is_finite() is_normal() is_subnormal() is_sign_negative() => bool);

            #[inline]
            fn total_cmp(self, other: $float) -> Ordering {
                $float::total_cmp(&self, &other)
            }
        }
    )*};
    ($float:ident: $($name:ident($($argument:ident: $type:ty),*))* => $output:ty) => {$(
        #[inline]
        fn $name(self $(, $argument: $type)*) -> $output {
            $float::$name(self $(, $argument)*)
        }
    )*};
}
primitive!(f64 f32);
