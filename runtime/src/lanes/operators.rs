//! `+`, `-`, `*`, `/` of lanes with lanes and with numbers.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::Lanes;
use crate::Scalar;

impl<T: Scalar, const S: usize> Neg for Lanes<T, S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|lane| -lane)
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $symbol:tt)*) => {$(
        impl<T: Scalar, const S: usize> $trait for Lanes<T, S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $symbol b)
            }
        }

        impl<T: Scalar, const S: usize> $trait<T> for Lanes<T, S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: T) -> Self {
                self.map(|lane| lane $symbol other)
            }
        }

        impl<const S: usize> $trait<Lanes<f64, S>> for f64 {
            type Output = Lanes<f64, S>;
            #[inline(always)]
            fn $method(self, other: Lanes<f64, S>) -> Lanes<f64, S> {
                other.map(|lane| self $symbol lane)
            }
        }

        impl<const S: usize> $trait<Lanes<f32, S>> for f32 {
            type Output = Lanes<f32, S>;
            #[inline(always)]
            fn $method(self, other: Lanes<f32, S>) -> Lanes<f32, S> {
                other.map(|lane| self $symbol lane)
            }
        }
    )*};
}

operators! {
    Add add +
    Sub sub -
    Mul mul *
    Div div /
}
