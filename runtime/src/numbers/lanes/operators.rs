//! `+`, `-`, `*`, `/` of lanes with lanes and with numbers.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::Lanes;
use crate::numbers::{Scalar, Vectors};

impl<T: Scalar, const S: usize> Neg for Lanes<T, S> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn neg(self) -> Self {
        self.map(|lane| -lane)
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $operation:ident)*) => {$(
        impl<T: Scalar, const S: usize> $trait for Lanes<T, S> {
            type Output = Self;
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn $method(self, other: Self) -> Self {
                Self(T::$operation(self.0, other.0))
            }
        }

        impl<T: Scalar, const S: usize> $trait<T> for Lanes<T, S> {
            type Output = Self;
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn $method(self, other: T) -> Self {
                Self(T::$operation(self.0, [other; S]))
            }
        }

        impl<const S: usize> $trait<Lanes<f64, S>> for f64 {
            type Output = Lanes<f64, S>;
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn $method(self, other: Lanes<f64, S>) -> Lanes<f64, S> {
                Lanes(f64::$operation([self; S], other.0))
            }
        }

        impl<const S: usize> $trait<Lanes<f32, S>> for f32 {
            type Output = Lanes<f32, S>;
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn $method(self, other: Lanes<f32, S>) -> Lanes<f32, S> {
                Lanes(f32::$operation([self; S], other.0))
            }
        }
    )*};
}

operators! {
    Add add sums
    Sub sub differences
    Mul mul products
    Div div quotients
}
