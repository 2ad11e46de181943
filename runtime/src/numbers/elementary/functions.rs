//! The table of elementary functions: a row for each that the standard library has and `core` has not.
//!
//! A row is a function's documentation, its name with its arguments behind `self`, and the functions of `f64`
//! and `f32` that take the place of the platform's, as `portable.rs` names them. The trait, lanes, members
//! and the guide are made of it; derivatives stand in `numbers/dual/real.rs`.

/// Calls `$continue!` with those functions of which several numbers take each for itself.
macro_rules! one_by_one {
    ($continue:ident!($($first:tt)*)) => {
        $continue! { $($first)*
            /// ∛x.
            cbrt() = libm::cbrt, single::cbrt;
            /// 2ˣ.
            exp2() = libm::exp2, single::exp2;
            /// eˣ − 1.
            exp_m1() = libm::expm1, libm::expm1f;
            /// Natural logarithm.
            ln() = libm::log, libm::logf;
            /// Logarithm to base 2.
            log2() = libm::log2, libm::log2f;
            /// Logarithm to base 10.
            log10() = libm::log10, libm::log10f;
            /// ln(1 + x).
            ln_1p() = libm::log1p, libm::log1pf;
            /// Tangent.
            tan() = libm::tan, single::tan;
            /// Arcsine.
            asin() = libm::asin, single::asin;
            /// Arccosine.
            acos() = libm::acos, libm::acosf;
            /// Arctangent.
            atan() = libm::atan, libm::atanf;
            /// Hyperbolic sine.
            sinh() = libm::sinh, libm::sinhf;
            /// Hyperbolic cosine.
            cosh() = libm::cosh, libm::coshf;
            /// Hyperbolic tangent.
            tanh() = libm::tanh, single::tanh;
            /// Inverse hyperbolic sine.
            asinh() = libm::asinh, libm::asinhf;
            /// Inverse hyperbolic cosine.
            acosh() = acosh, single::acosh;
            /// Inverse hyperbolic tangent.
            atanh() = libm::atanh, libm::atanhf;
            /// xⁿ, n a real number.
            powf(n: Self) = libm::pow, libm::powf;
            /// Angle of the point (other, self).
            atan2(other: Self) = libm::atan2, libm::atan2f;
            /// √(self² + other²), without overflow on the way.
            hypot(other: Self) = libm::hypot, single::hypot;
            /// self·a + b, rounded once.
            mul_add(a: Self, b: Self) = libm::fma, libm::fmaf;
        }
    };
}

/// Calls `$continue!` with all rows: those of several numbers at once, or none, come first.
macro_rules! functions {
    ($continue:ident!($($first:tt)*)) => {
        $crate::numbers::one_by_one! { $continue!($($first)*
            /// √x, rounded correctly.
            sqrt() = libm::sqrt, libm::sqrtf;
            /// eˣ.
            exp() = libm::exp, libm::expf;
            /// Sine.
            sin() = libm::sin, single::sin;
            /// Cosine.
            cos() = libm::cos, single::cos;
            /// Logarithm to any base.
            log(base: Self) = log, log;
            /// xⁿ, n an integer.
            powi(n: i32) = powi, powi;
        ) }
    };
}

/// The names of all rows, for documentation.
macro_rules! names {
    ($($(#[$doc:meta])* $name:ident($($argument:ident: $type:tt),*) = $double:path, $single:path;)*) => {
        concat!($("`", stringify!($name), "` "),*)
    };
}

pub(crate) use {functions, names, one_by_one};
