//! Elementary functions of `f64` and `f32`: the platform's, or the same on every machine.
//!
//! | features | functions |
//! |---|---|
//! | `std` | those of the standard library |
//! | `std` and `libm` | those of the next row, so that a host repeats a microcontroller bit by bit |
//! | without `std` | those of the crate libm; for `f32`, where libm computes in `f64`, those of `elementary/single.rs` |
//!
//! Everything that this crate evaluates (generated systems, dual numbers) takes its elementary functions from
//! here.

use crate::numbers::Scalar;
use functions::functions;

pub(crate) mod functions;
#[cfg(all(feature = "std", not(feature = "libm")))]
mod platform;
#[cfg(any(not(feature = "std"), feature = "libm"))]
mod portable;
#[cfg(any(test, not(feature = "std"), feature = "libm"))]
mod single;

macro_rules! elementary {
    ($($(#[$doc:meta])* $name:ident($($argument:ident: $type:tt),*) = $double:path, $single:path;)*) => {
        /// The elementary functions of the scalar types, under the names of the standard library.
        ///
        /// With `std`, methods of `f64` and `f32` come before those of a trait, and `x.sin()` is the standard
        /// library's. Without, import this trait and `x.sin()` is here. `Elementary::sin(x)` is the one that
        /// generated systems evaluate, in any case.
        pub trait Elementary: Scalar {
            $(
                $(#[$doc])*
                #[must_use]
                fn $name(self $(, $argument: $type)*) -> Self;
            )*

            /// Sine and cosine, the same numbers as [`sin`](Self::sin) and [`cos`](Self::cos) give.
            #[must_use]
            fn sin_cos(self) -> (Self, Self);

            /// The number with the methods of this trait, and none of its own that go by the same names.
            #[doc(hidden)]
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn elementary(self) -> Chosen<Self> {
                Chosen(self)
            }

            /// The number with sine, cosine and exponential in the form that several numbers at once have.
            #[doc(hidden)]
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn branch_free(self) -> BranchFree<Self> {
                BranchFree(self)
            }
        }

        impl<S: Elementary> Chosen<S> {
            $(
                $(#[$doc])*
                #[cfg_attr(not(debug_assertions), inline(always))]
                #[must_use]
                pub fn $name(self $(, $argument: arguments!(S $type))*) -> S {
                    Elementary::$name(self.0 $(, $argument)*)
                }
            )*

            /// Sine and cosine.
            #[cfg_attr(not(debug_assertions), inline(always))]
            #[must_use]
            pub fn sin_cos(self) -> (S, S) {
                Elementary::sin_cos(self.0)
            }
        }
    };
}

/// `Self` of the trait is the scalar.
macro_rules! arguments {
    ($scalar:ident Self) => {
        $scalar
    };
    ($scalar:ident $type:tt) => {
        $type
    };
}

/// A number with the functions of [`Elementary`]: `x.sin()` of a body becomes `x.elementary().sin()` where it
/// must not be the standard library's.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Chosen<S>(S);

/// A number with functions that lanes of members share to the last bit: `x.sin()` of a force becomes
/// `x.branch_free().sin()`.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct BranchFree<S>(S);

impl<S: Scalar> BranchFree<S> {
    /// Sine and cosine.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn sin_cos(self) -> (S, S) {
        let ([sine], [cosine]) = S::sines_and_cosines([self.0]);
        (sine, cosine)
    }

    /// Sine.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn sin(self) -> S {
        self.sin_cos().0
    }

    /// Cosine.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn cos(self) -> S {
        self.sin_cos().1
    }

    /// eˣ.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn exp(self) -> S {
        let [exponential] = S::exponentials([self.0]);
        exponential
    }
}

functions!(elementary!());
