//! Elementary functions that do not depend on the machine: those of libm, and for `f32` our own where libm's
//! compute in `f64`.

use super::functions::functions;
use super::{Elementary, single};
use crate::numbers::Scalar;

macro_rules! portable {
    ($($(#[$doc:meta])* $name:ident($($argument:ident: $type:tt),*) = $double:path, $single:path;)*) => {
        impl Elementary for f64 {
            $(
                #[inline]
                fn $name(self $(, $argument: $type)*) -> Self {
                    $double(self $(, $argument)*)
                }
            )*

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                libm::sincos(self)
            }
        }

        impl Elementary for f32 {
            $(
                #[inline]
                fn $name(self $(, $argument: $type)*) -> Self {
                    $single(self $(, $argument)*)
                }
            )*

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                single::sin_cos(self)
            }
        }
    };
}

functions!(portable!());

/// libm's value at x ≤ −1 is a number; there is none.
#[inline]
fn acosh(x: f64) -> f64 {
    if x < 1.0 { f64::NAN } else { libm::acosh(x) }
}

#[inline]
fn log<S: Elementary>(x: S, base: S) -> S {
    Elementary::ln(x) / Elementary::ln(base)
}

/// The products in the order in which the standard library's `powi` forms them.
#[inline]
fn powi<S: Scalar>(x: S, n: i32) -> S {
    let (mut square, mut left) = (x, n.unsigned_abs());
    let mut power = S::one();
    while left > 0 {
        if left % 2 == 1 {
            power *= square;
        }
        left /= 2;
        square *= square;
    }
    if n < 0 { S::one() / power } else { power }
}
