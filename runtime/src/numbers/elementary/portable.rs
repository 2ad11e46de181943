//! Elementary functions that do not depend on the machine: those of libm, and for `f32` our own where libm's
//! compute in `f64`.

use super::{Elementary, single};

macro_rules! portable {
    ($float:ident: $($name:ident($($argument:ident: $type:ty),*) = $function:path;)*) => {
        impl Elementary for $float {
            $(
                #[inline]
                fn $name(self $(, $argument: $type)*) -> Self {
                    $function(self $(, $argument)*)
                }
            )*

            #[inline]
            fn log(self, base: Self) -> Self {
                Elementary::ln(self) / Elementary::ln(base)
            }

            /// The products in the order in which the standard library's `powi` forms them.
            #[inline]
            fn powi(self, n: i32) -> Self {
                let (mut square, mut left) = (self, n.unsigned_abs());
                let mut power = 1.0;
                while left > 0 {
                    if left % 2 == 1 {
                        power *= square;
                    }
                    left /= 2;
                    square *= square;
                }
                if n < 0 { 1.0 / power } else { power }
            }

            portable!(@sin_cos $float);
        }
    };
    (@sin_cos f64) => {
        #[inline]
        fn sin_cos(self) -> (Self, Self) {
            libm::sincos(self)
        }
    };
    (@sin_cos f32) => {
        #[inline]
        fn sin_cos(self) -> (Self, Self) {
            single::sin_cos(self)
        }
    };
}

portable! {
    f64:
    sqrt() = libm::sqrt;
    cbrt() = libm::cbrt;
    exp() = libm::exp;
    exp2() = libm::exp2;
    exp_m1() = libm::expm1;
    ln() = libm::log;
    log2() = libm::log2;
    log10() = libm::log10;
    ln_1p() = libm::log1p;
    sin() = libm::sin;
    cos() = libm::cos;
    tan() = libm::tan;
    asin() = libm::asin;
    acos() = libm::acos;
    atan() = libm::atan;
    sinh() = libm::sinh;
    cosh() = libm::cosh;
    tanh() = libm::tanh;
    asinh() = libm::asinh;
    acosh() = acosh;
    atanh() = libm::atanh;
    powf(n: Self) = libm::pow;
    atan2(other: Self) = libm::atan2;
    hypot(other: Self) = libm::hypot;
    mul_add(a: Self, b: Self) = libm::fma;
}

portable! {
    f32:
    sqrt() = libm::sqrtf;
    cbrt() = single::cbrt;
    exp() = libm::expf;
    exp2() = single::exp2;
    exp_m1() = libm::expm1f;
    ln() = libm::logf;
    log2() = libm::log2f;
    log10() = libm::log10f;
    ln_1p() = libm::log1pf;
    sin() = single::sin;
    cos() = single::cos;
    tan() = single::tan;
    asin() = single::asin;
    acos() = libm::acosf;
    atan() = libm::atanf;
    sinh() = libm::sinhf;
    cosh() = libm::coshf;
    tanh() = single::tanh;
    asinh() = libm::asinhf;
    acosh() = single::acosh;
    atanh() = libm::atanhf;
    powf(n: Self) = libm::powf;
    atan2(other: Self) = libm::atan2f;
    hypot(other: Self) = single::hypot;
    mul_add(a: Self, b: Self) = libm::fmaf;
}

/// libm's value at x ≤ −1 is a number; there is none.
#[inline]
fn acosh(x: f64) -> f64 {
    if x < 1.0 { f64::NAN } else { libm::acosh(x) }
}
