//! `+`, `-`, `*`, `/` of members with members and with numbers.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::{Members, each_member};
use crate::numbers::Scalar;

impl<T: Scalar, const W: usize> Neg for Members<T, W> {
    type Output = Self;
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn neg(mut self) -> Self {
        each_member!(i => {
            self.0[i] = -self.0[i];
        });
        self
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $operator:tt $assigning:tt)*) => {$(
        impl<T: Scalar, const W: usize> $trait for Members<T, W> {
            type Output = Self;
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn $method(mut self, other: Self) -> Self {
                each_member!(i => {
                    self.0[i] $assigning other.0[i];
                });
                self
            }
        }

        impl<T: Scalar, const W: usize> $trait<T> for Members<T, W> {
            type Output = Self;
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn $method(mut self, other: T) -> Self {
                each_member!(i => {
                    self.0[i] $assigning other;
                });
                self
            }
        }

        operators!(@number $trait $method $operator f64 f32);
    )*};
    (@number $trait:ident $method:ident $operator:tt $($scalar:ident)*) => {$(
        impl<const W: usize> $trait<Members<$scalar, W>> for $scalar {
            type Output = Members<$scalar, W>;
            #[cfg_attr(not(debug_assertions), inline(always))]
            fn $method(self, other: Members<$scalar, W>) -> Members<$scalar, W> {
                Members::splat(self) $operator other
            }
        }
    )*};
}

operators! {
    Add add + +=
    Sub sub - -=
    Mul mul * *=
    Div div / /=
}
