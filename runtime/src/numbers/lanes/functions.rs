//! Elementary functions of lanes: sine, cosine and exponential of all at once, the others lane by lane
//! through those of numbers.

use super::Lanes;
use crate::numbers::{Elementary, Scalar, one_by_one};

/// Functions that go lane by lane.
macro_rules! lane_by_lane {
    ($($(#[$doc:meta])* $name:ident($($argument:ident: $type:tt),*) = $double:path, $single:path;)*) => {
        impl<T: Elementary, const S: usize> Lanes<T, S> {
            $(
                $(#[$doc])*
                #[cfg_attr(not(debug_assertions), inline(always))]
                #[must_use]
                pub fn $name(self $(, $argument: $type)*) -> Self {
                    let mut result = self;
                    for i in 0..S {
                        result.0[i] = Elementary::$name(self.0[i] $(, $argument.0[i])*);
                    }
                    result
                }
            )*
        }
    };
}

one_by_one!(lane_by_lane!());

impl<T: Scalar, const S: usize> Lanes<T, S> {
    /// Sine and cosine.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn sin_cos(self) -> (Self, Self) {
        let (sines, cosines) = T::sines_and_cosines(self.0);
        (Self(sines), Self(cosines))
    }

    /// The sine.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// The cosine.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// eˣ.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn exp(self) -> Self {
        Self(T::exponentials(self.0))
    }

    /// The absolute value.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn abs(self) -> Self {
        Self(T::sizes(self.0))
    }

    /// The square root; NaN of a negative number.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn sqrt(self) -> Self {
        Self(T::roots(self.0))
    }

    /// 1 with the sign of x; NaN of NaN.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn signum(self) -> Self {
        self.is_nan().select(self, Self::splat(T::one()).copysign(self))
    }

    /// The absolute value of the one with the sign of the other.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn copysign(self, sign: Self) -> Self {
        self.zip(sign, nalgebra::RealField::copysign)
    }

    /// 1/x.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn recip(self) -> Self {
        Self::splat(T::one()) / self
    }
}

impl<T: Elementary, const S: usize> Lanes<T, S> {
    /// xⁿ.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        self.map(|lane| Elementary::powi(lane, n))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_out_of_range_go_one_by_one() {
        let x = Lanes([1e9, 0.3, f64::INFINITY, f64::NAN]);
        let (sines, cosines) = x.sin_cos();
        assert_eq!((sines.0[0], cosines.0[0]), 1e9_f64.sin_cos());
        assert_eq!((sines.0[1], cosines.0[1]), 0.3_f64.sin_cos());
        assert!(sines.0[2].is_nan() && cosines.0[3].is_nan());
        assert_eq!(Lanes([800.0, -800.0]).exp().0, [f64::INFINITY, 0.0]);
        assert_eq!(Lanes([0.0_f64, -0.0]).sin().0.map(f64::to_bits), [0.0_f64, -0.0].map(f64::to_bits));
    }

    #[test]
    fn the_others_are_those_of_numbers() {
        let x = Lanes([0.25_f64, -0.5, f64::NAN, 0.0]);
        let same = |a: Lanes<f64, 4>, f: fn(f64) -> f64| {
            for (a, x) in a.0.iter().zip(x.0) {
                assert!(*a == f(x) || (a.is_nan() && f(x).is_nan()), "{a} {}", f(x));
            }
        };
        same(x.sqrt(), f64::sqrt);
        same(x.signum(), f64::signum);
        same(x.abs(), f64::abs);
        same(x.cbrt(), f64::cbrt);
        same(x.exp2(), f64::exp2);
        same(x.ln_1p(), f64::ln_1p);
        same(x.powi(5), |x| x.powi(5));
        same(x.mul_add(x, Lanes::splat(1.0)), |x| x.mul_add(x, 1.0));
        assert_eq!(Lanes([3.0, -1.0]).hypot(Lanes([4.0, 0.0])).0, [5.0, 1.0]);
        assert_eq!(
            Lanes([3.0, -1.0]).atan2(Lanes([4.0, 0.0])).0,
            [3.0_f64.atan2(4.0), (-1.0_f64).atan2(0.0)]
        );
        assert_eq!(Lanes([0.5_f32, 9.0]).sin().0, [0.5_f32.sin(), 9.0_f32.sin()]);
    }
}
