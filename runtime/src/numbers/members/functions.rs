//! Elementary functions of members: sine, cosine and exponential in the form that
//! [`branch_free`](crate::numbers::Elementary::branch_free) gives of one number, the others one by one
//! through those of numbers; so they are rounded alike.

use super::{Members, each_member};
use crate::numbers::{Elementary, Scalar, one_by_one};

/// Functions that go member by member.
macro_rules! member_by_member {
    ($($(#[$doc:meta])* $name:ident($($argument:ident: $type:tt),*) = $double:path, $single:path;)*) => {
        impl<T: Elementary, const W: usize> Members<T, W> {
            $(
                $(#[$doc])*
                #[cfg_attr(not(debug_assertions), inline(always))]
                #[must_use]
                pub fn $name(mut self $(, $argument: $type)*) -> Self {
                    each_member!(i => {
                        self.0[i] = Elementary::$name(self.0[i] $(, $argument.0[i])*);
                    });
                    self
                }
            )*
        }
    };
}

one_by_one!(member_by_member!());

impl<T: Elementary, const W: usize> Members<T, W> {
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

    /// xⁿ.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn powi(mut self, n: i32) -> Self {
        each_member!(i => {
            self.0[i] = Elementary::powi(self.0[i], n);
        });
        self
    }

    /// √x.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn sqrt(mut self) -> Self {
        each_member!(i => {
            self.0[i] = Elementary::sqrt(self.0[i]);
        });
        self
    }
}

impl<T: Scalar, const W: usize> Members<T, W> {
    /// 1/x.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn recip(self) -> Self {
        Self::splat(T::one()) / self
    }

    /// The absolute value.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn abs(mut self) -> Self {
        each_member!(i => {
            self.0[i] = nalgebra::ComplexField::abs(self.0[i]);
        });
        self
    }

    /// The absolute value of the one with the sign of the other.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn copysign(mut self, sign: Self) -> Self {
        each_member!(i => {
            self.0[i] = nalgebra::RealField::copysign(self.0[i], sign.0[i]);
        });
        self
    }

    /// 1 with the sign of x; NaN of NaN.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn signum(self) -> Self {
        Self::select(self.is_nan(), self, Self::splat(T::one()).copysign(self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: [f64; 8] = [0.25, -0.5, 0.0, -0.0, 9.0, 1e9, f64::INFINITY, f64::NAN];

    fn bits(x: f64) -> u64 {
        if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() }
    }

    /// The function of members beside that of each number.
    macro_rules! same {
        ($($name:ident($($argument:expr),*))*) => {$(
            let of_members = Members(X).$name($(Members([$argument; 8])),*);
            let of_numbers = X.map(|x| bits(Elementary::$name(x $(, $argument)*)));
            assert_eq!(of_members.0.map(bits), of_numbers, stringify!($name));
        )*};
    }

    #[test]
    fn functions_are_those_of_numbers_to_the_last_bit() {
        same! {
            sqrt() cbrt() exp2() exp_m1() ln() log2() log10() ln_1p() tan() asin() acos() atan()
            sinh() cosh() tanh() asinh() acosh() atanh() powf(1.7) atan2(-0.3) hypot(0.7) mul_add(0.1, 0.3)
        }
        let (sines, cosines) = Members(X).sin_cos();
        assert_eq!(sines.0.map(bits), X.map(|x| bits(x.branch_free().sin())));
        assert_eq!(cosines.0.map(bits), X.map(|x| bits(x.branch_free().cos())));
        assert_eq!(Members(X).sin().0.map(bits), X.map(|x| bits(x.branch_free().sin_cos().0)));
        assert_eq!(Members(X).cos().0.map(bits), X.map(|x| bits(x.branch_free().sin_cos().1)));
        assert_eq!(Members(X).exp().0.map(bits), X.map(|x| bits(x.branch_free().exp())));
        assert_eq!(Members(X).powi(5).0.map(bits), X.map(|x| bits(Elementary::powi(x, 5))));
        assert_eq!(Members(X).recip().0.map(bits), X.map(|x| bits(x.recip())));
        assert_eq!(Members(X).abs().0.map(bits), X.map(|x| bits(x.abs())));
        assert_eq!(Members(X).signum().0.map(bits), X.map(|x| bits(x.signum())));
        // The control: the platform's sine differs somewhere in the last place.
        let (mut x, mut differ) = (0.0, 0);
        for _ in 0..1000 {
            x += 0.37;
            differ += usize::from(Members([x; 2]).sin().0[0] != Elementary::sin(x));
            assert_eq!(Members([x; 2]).sin().0, crate::numbers::Lanes([x; 2]).sin().0);
        }
        assert!(differ > 0);
    }

    #[test]
    fn conditions_are_those_of_numbers() {
        let (a, b) = (Members(X), Members([0.0; 8]));
        assert_eq!(a.less(b).0, X.map(|x| x < 0.0));
        assert_eq!(a.less_or_equal(b).0, X.map(|x| x <= 0.0));
        assert_eq!(a.equal(b).0, X.map(|x| x == 0.0));
        assert_eq!((a.is_nan().0, a.is_finite().0), (X.map(f64::is_nan), X.map(f64::is_finite)));
        assert_eq!(a.is_infinite().0, X.map(f64::is_infinite));
        assert_eq!(a.is_sign_negative().0, X.map(f64::is_sign_negative));
        assert_eq!(a.is_sign_positive().0, X.map(f64::is_sign_positive));
        let chosen = Members::select(a.less(b), a, b).0.map(bits);
        assert_eq!(chosen, X.map(|x| bits(if x < 0.0 { x } else { 0.0 })));
    }
}
