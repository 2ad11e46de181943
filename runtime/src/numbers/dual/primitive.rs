//! Functions that the dual engine asks of `f64` and `f32` beside arithmetic.

use core::cmp::Ordering;

use num_dual::DualNumFloat;

use super::Dual;
use crate::numbers::Elementary;

/// A plain scalar: its elementary functions, and exact ones.
pub trait Primitive: Elementary + DualNumFloat + Dual<Self> {
    /// 1/x.
    fn recip(self) -> Self;
    /// |x|.
    fn abs(self) -> Self;
    /// ±1 by the sign bit, NaN for NaN.
    fn signum(self) -> Self;
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
            primitive!($float: recip() abs() signum() midpoint(other: $float) to_radians() to_degrees() => $float);
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
