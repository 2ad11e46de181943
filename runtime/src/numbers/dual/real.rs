//! The scalar of a differentiated body, and its methods.

use core::cmp::Ordering;

use super::primitive::Primitive;
use super::refused::Roundable;
use super::{Dual, Over};
use crate::numbers::Elementary;

/// The number that stands for `f64` (or `f32`) in a differentiated body: of type `D`, plain or dual.
///
/// Operators take `Real<D>`, references to it and plain numbers, in any mixture, as `f64` does. Methods are
/// those of `f64` that have a derivative; they give the value that `f64` gives.
///
/// # Where a derivative does not exist
///
/// Derivatives written out at compile time and those of this type are the same there: one-sided limits where
/// there is a side, infinite where the slope is, NaN where the direction decides. Whatever does not depend on
/// the argument of a singular function keeps its own derivative, 0 by that argument.
///
/// | at | value | derivative | second derivative |
/// |---|---|---|---|
/// | `abs` at ±0 | 0 | sign of the zero | 0 |
/// | `signum`; `copysign`, by the sign | as `f64` | 0 | 0 |
/// | `min`, `max` of equal numbers; with one NaN | the first; the number | that of the first; of the number | the same |
/// | `clamp` at a bound | the bound | that of the number, as inside | the same |
/// | `sqrt` at ±0 | ±0 | ±∞ | −∞ |
/// | `cbrt` at ±0 | ±0 | ∞ | ∓∞ |
/// | `powf` with constant n at 0 | as `f64` | n xⁿ⁻¹, 0 for n = 0 | n(n−1) xⁿ⁻², 0 for n = 0, 1 |
/// | `powf` with n depending on q or v, base ≤ 0 | as `f64` | by the base as for constant n; by n NaN | the same; mixed NaN |
/// | `powi` with n < 0 at 0, `recip`, a/b at b = 0 | ∞ (0/0: NaN) | as the formula: −∞ for 1/x (0/0: NaN) | ∞ |
/// | `ln`, `log2`, `log10` at 0, `ln_1p` at −1 | −∞ | ∞ | −∞ |
/// | the same below | NaN | 1/x, as of ln │x│ | −1/x² |
/// | `asin`, `acos` at ±1 | ±π/2; 0, π | ∞; −∞ | ±∞; ∓∞ |
/// | `acosh` at 1 | 0 | ∞ | −∞ |
/// | `atanh` at ±1 | ±∞ | ∞ | ±∞ |
/// | `sqrt`, `powf`, `asin`, `acos` outside their domain, `acosh` in (−1, 1) | NaN | NaN | NaN |
/// | `hypot`, `atan2` at (0, 0) | 0 | NaN | NaN |
///
/// An infinite derivative times one that happens to be 0 is NaN, as for √(x²) at 0: it is 0 only where there
/// is no dependence at all. What is summed up from infinite derivatives is not finite, ∞ or NaN by the order
/// of the sum.
#[derive(Clone, Copy)]
pub struct Real<D>(pub D);

/// Methods of `f64` without a derivative: the bound gives their use a message of its own.
macro_rules! refuse {
    ($($name:ident($($argument:ident)?))*) => {$(
        /// Refused: see [`Roundable`].
        #[inline]
        #[must_use]
        pub fn $name(self $(, $argument: Self)?) -> Self
        where
            Self: Roundable,
        {
            $(let _ = $argument;)?
            self
        }
    )*};
}

impl<D, F> Real<D>
where
    F: Primitive,
    D: Dual<F> + Over<Primitive = F>,
{
    refuse! {
        floor() ceil() round() round_ties_even() trunc() fract() next_up() next_down() to_bits()
        rem_euclid(right) div_euclid(right)
    }

    /// g(self), from g and its first three derivatives as functions of the value.
    #[inline]
    fn chain(self, g: [F; 4]) -> Self {
        Self(self.0.chain(g))
    }

    /// 1/x.
    #[inline]
    #[must_use]
    pub fn recip(self) -> Self {
        let r = Primitive::recip(self.0.primal());
        let square = r * r;
        self.chain([r, -square, F::constant(2.0) * square * r, F::constant(-6.0) * square * square])
    }

    /// eˣ.
    #[inline]
    #[must_use]
    pub fn exp(self) -> Self {
        self.chain([Elementary::exp(self.0.primal()); 4])
    }

    /// 2ˣ.
    #[inline]
    #[must_use]
    pub fn exp2(self) -> Self {
        let (power, ln2) = (Elementary::exp2(self.0.primal()), F::constant(core::f64::consts::LN_2));
        self.chain([power, ln2 * power, ln2 * ln2 * power, ln2 * ln2 * ln2 * power])
    }

    /// eˣ − 1, accurate near 0.
    #[inline]
    #[must_use]
    pub fn exp_m1(self) -> Self {
        let exp = Elementary::exp(self.0.primal());
        self.chain([Elementary::exp_m1(self.0.primal()), exp, exp, exp])
    }

    /// Natural logarithm.
    #[inline]
    #[must_use]
    pub fn ln(self) -> Self {
        let x = self.0.primal();
        self.logarithm(Elementary::ln(x), Primitive::recip(x), F::constant(1.0))
    }

    /// Logarithm to base 2.
    #[inline]
    #[must_use]
    pub fn log2(self) -> Self {
        let x = self.0.primal();
        self.logarithm(Elementary::log2(x), Primitive::recip(x), F::constant(core::f64::consts::LOG2_E))
    }

    /// Logarithm to base 10.
    #[inline]
    #[must_use]
    pub fn log10(self) -> Self {
        let x = self.0.primal();
        self.logarithm(Elementary::log10(x), Primitive::recip(x), F::constant(core::f64::consts::LOG10_E))
    }

    /// ln(1 + x), accurate near 0.
    #[inline]
    #[must_use]
    pub fn ln_1p(self) -> Self {
        let x = self.0.primal();
        self.logarithm(Elementary::ln_1p(x), Primitive::recip(F::constant(1.0) + x), F::constant(1.0))
    }

    /// A function with the derivative `scale`·r, r the reciprocal of its argument up to a shift.
    #[inline]
    fn logarithm(self, value: F, r: F, scale: F) -> Self {
        self.chain([value, scale * r, -scale * r * r, F::constant(2.0) * scale * r * r * r])
    }

    /// Sine.
    #[inline]
    #[must_use]
    pub fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// Cosine.
    #[inline]
    #[must_use]
    pub fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// Sine and cosine.
    #[inline]
    #[must_use]
    pub fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = Elementary::sin_cos(self.0.primal());
        (self.chain([sine, cosine, -sine, -cosine]), self.chain([cosine, -sine, -cosine, sine]))
    }

    /// Arcsine.
    #[inline]
    #[must_use]
    pub fn asin(self) -> Self {
        let x = self.0.primal();
        self.arc(Elementary::asin(x), F::constant(1.0))
    }

    /// Arccosine.
    #[inline]
    #[must_use]
    pub fn acos(self) -> Self {
        let x = self.0.primal();
        self.arc(Elementary::acos(x), F::constant(-1.0))
    }

    /// A function with the derivative ±1/√(1 − x²).
    #[inline]
    fn arc(self, value: F, sign: F) -> Self {
        let [one, two] = [1.0, 2.0].map(F::constant);
        let x = self.0.primal();
        let square = one / ((one - x) * (one + x));
        let first = sign * Elementary::sqrt(square);
        self.chain([value, first, x * first * square, (one + two * x * x) * first * square * square])
    }

    /// Arctangent.
    #[inline]
    #[must_use]
    pub fn atan(self) -> Self {
        let [one, two, six] = [1.0, 2.0, 6.0].map(F::constant);
        let x = self.0.primal();
        let first = one / (one + x * x);
        let square = first * first;
        self.chain([Elementary::atan(x), first, -two * x * square, (six * x * x - two) * square * first])
    }

    /// Hyperbolic sine.
    #[inline]
    #[must_use]
    pub fn sinh(self) -> Self {
        let (sinh, cosh) = (Elementary::sinh(self.0.primal()), Elementary::cosh(self.0.primal()));
        self.chain([sinh, cosh, sinh, cosh])
    }

    /// Hyperbolic cosine.
    #[inline]
    #[must_use]
    pub fn cosh(self) -> Self {
        let (sinh, cosh) = (Elementary::sinh(self.0.primal()), Elementary::cosh(self.0.primal()));
        self.chain([cosh, sinh, cosh, sinh])
    }

    /// Inverse hyperbolic sine.
    #[inline]
    #[must_use]
    pub fn asinh(self) -> Self {
        let [one, two] = [1.0, 2.0].map(F::constant);
        let x = self.0.primal();
        let square = one / (one + x * x);
        let first = Elementary::sqrt(square);
        self.chain([
            Elementary::asinh(x),
            first,
            -x * first * square,
            (two * x * x - one) * first * square * square,
        ])
    }

    /// Inverse hyperbolic cosine.
    #[inline]
    #[must_use]
    pub fn acosh(self) -> Self {
        let [one, two] = [1.0, 2.0].map(F::constant);
        let x = self.0.primal();
        let square = one / ((x - one) * (x + one));
        let first = Elementary::sqrt(square);
        self.chain([
            Elementary::acosh(x),
            first,
            -x * first * square,
            (two * x * x + one) * first * square * square,
        ])
    }

    /// Inverse hyperbolic tangent.
    #[inline]
    #[must_use]
    pub fn atanh(self) -> Self {
        let [one, two, six] = [1.0, 2.0, 6.0].map(F::constant);
        let x = self.0.primal();
        let first = one / ((one - x) * (one + x));
        let square = first * first;
        self.chain([Elementary::atanh(x), first, two * x * square, (two + six * x * x) * square * first])
    }

    /// Tangent. num-dual divides sine by cosine, which rounds differently from `f64::tan`.
    #[inline]
    #[must_use]
    pub fn tan(self) -> Self {
        let [one, two, three] = [1.0, 2.0, 3.0].map(F::constant);
        let t = Elementary::tan(self.0.primal());
        let slope = one + t * t;
        self.chain([t, slope, two * t * slope, two * slope * (one + three * t * t)])
    }

    /// Hyperbolic tangent. num-dual divides sinh by cosh: NaN beyond |x| ≈ 710. Here the slope comes from
    /// e^(−2|x|).
    #[inline]
    #[must_use]
    pub fn tanh(self) -> Self {
        let [one, two, four] = [1.0, 2.0, 4.0].map(F::constant);
        let x = self.0.primal();
        let t = Elementary::tanh(x);
        let decay = Elementary::exp(-two * Primitive::abs(x));
        let slope = four * decay / ((one + decay) * (one + decay));
        self.chain([t, slope, -two * t * slope, slope * (four * t * t - two * slope)])
    }

    /// Square root.
    #[inline]
    #[must_use]
    pub fn sqrt(self) -> Self {
        let x = self.0.primal();
        let root = Elementary::sqrt(x);
        let first = F::constant(0.5) / root;
        let second = F::constant(-0.5) * first / x;
        self.chain([root, first, second, F::constant(-1.5) * second / x])
    }

    /// Cube root.
    #[inline]
    #[must_use]
    pub fn cbrt(self) -> Self {
        let [one, two, three, five] = [1.0, 2.0, 3.0, 5.0].map(F::constant);
        let x = self.0.primal();
        let root = Elementary::cbrt(x);
        let first = one / (three * root * root);
        let second = -two * first / (three * x);
        self.chain([root, first, second, -five * second / (three * x)])
    }

    /// Integer power.
    #[inline]
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        match n {
            0 => D::real(F::constant(1.0)),
            1 => self,
            2 => self * self,
            3 => self * self * self,
            _ => {
                let x = self.0.primal();
                let mut factor = F::constant(1.0);
                self.chain([0, 1, 2, 3].map(|order: i32| {
                    let exponent = n.saturating_sub(order);
                    let term = factor * Elementary::powi(x, exponent);
                    factor *= F::constant(f64::from(exponent));
                    term
                }))
            }
        }
    }

    /// Real power. An exponent that depends on q or v needs a positive base, as its derivative is xⁿ ln x.
    #[inline]
    #[must_use]
    pub fn powf(self, exponent: Self) -> Self {
        let (x, n) = (self.0.primal(), exponent.0.primal());
        if !exponent.0.is_constant() {
            let value = Elementary::powf(x, n);
            return (exponent * self.ln()).chain([value; 4]);
        }
        let mut factor = F::constant(1.0);
        self.chain([0.0, 1.0, 2.0, 3.0].map(|order| {
            let exponent = n - F::constant(order);
            // n(n−1)…(n−k+1) x^(n−k) vanishes for a whole n < k, also where the power itself is infinite.
            let vanishes = factor == F::constant(0.0);
            let term = if vanishes { factor } else { factor * Elementary::powf(x, exponent) };
            factor *= exponent;
            term
        }))
    }

    /// Logarithm to any base.
    #[inline]
    #[must_use]
    pub fn log(self, base: Self) -> Self {
        self.ln() / base.ln()
    }

    /// Angle of the point (`x`, self), with the derivative (x dy − y dx)/(x² + y²).
    #[inline]
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        let y = self;
        let angle = Elementary::atan2(y.0.primal(), x.0.primal());
        // Both quotients have the derivative of the angle; the one with the larger divisor is finite.
        let quotient = if Primitive::abs(x.0.primal()) >= Primitive::abs(y.0.primal()) {
            (y / x).atan()
        } else {
            -(x / y).atan()
        };
        Self(quotient.0.with_primal(angle))
    }

    /// √(x² + y²), without overflow on the way.
    #[inline]
    #[must_use]
    pub fn hypot(self, other: Self) -> Self {
        let (x, y) = (self.0.primal(), other.0.primal());
        let value = Elementary::hypot(x, y);
        let (cosine, sine) = (D::real(x / value), D::real(y / value));
        // Along the vector and across it, where the value is 0: √(u² + w²) = u + w²/2u up to w⁴, with 1/u =
        // (2 − u/r)/r up to (u/r − 1)², r the value. A quotient by u itself would have derivatives of
        // 1/r², which overflow before 1/r does.
        let along = Self((self * cosine + other * sine).0.with_primal(value));
        let across = Self((other * cosine - self * sine).0.with_primal(F::constant(0.0)));
        let per_value = D::real(F::constant(1.0) / value);
        let inverse = D::real(F::constant(2.0)) - Self((along * per_value).0.with_primal(F::constant(1.0)));
        // The square first: it has no first derivative, which times that of the inverse would overflow.
        let bend = (across * (across * D::real(F::constant(0.5) / value))) * inverse;
        Self((along + bend).0.with_primal(value))
    }

    /// |x|.
    #[inline]
    #[must_use]
    pub fn abs(self) -> Self {
        if self.is_sign_negative() { -self } else { self }
    }

    /// 1 or −1 by the sign bit, NaN for NaN; derivative 0.
    #[inline]
    #[must_use]
    pub fn signum(self) -> Self {
        D::real(Primitive::signum(self.0.primal()))
    }

    /// |self| with the sign of `sign`.
    #[inline]
    #[must_use]
    pub fn copysign(self, sign: Self) -> Self {
        if self.is_sign_negative() == sign.is_sign_negative() { self } else { -self }
    }

    /// The smaller number; NaN only where both are.
    #[inline]
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        if other < self || self.is_nan() { other } else { self }
    }

    /// The larger number; NaN only where both are.
    #[inline]
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        if other > self || self.is_nan() { other } else { self }
    }

    /// The number limited to [`low`, `high`]. Where `low` > `high`, on which `f64::clamp` panics, it is
    /// `high`.
    #[inline]
    #[must_use]
    pub fn clamp(self, low: Self, high: Self) -> Self {
        if self > high {
            high
        } else if self < low {
            low
        } else {
            self
        }
    }

    /// self·a + b, rounded once.
    #[inline]
    #[must_use]
    pub fn mul_add(self, a: Self, b: Self) -> Self {
        let value = Elementary::mul_add(self.0.primal(), a.0.primal(), b.0.primal());
        Self((self * a + b).0.with_primal(value))
    }

    /// Half the sum, without overflow on the way.
    #[inline]
    #[must_use]
    pub fn midpoint(self, other: Self) -> Self {
        let half = D::real(F::constant(0.5));
        let value = Primitive::midpoint(self.0.primal(), other.0.primal());
        Self((self * half + other * half).0.with_primal(value))
    }

    /// Degrees to radians.
    #[inline]
    #[must_use]
    pub fn to_radians(self) -> Self {
        let radians = self * D::real(F::constant(core::f64::consts::PI / 180.0));
        Self(radians.0.with_primal(Primitive::to_radians(self.0.primal())))
    }

    /// Radians to degrees.
    #[inline]
    #[must_use]
    pub fn to_degrees(self) -> Self {
        let degrees = self * D::real(F::constant(180.0 / core::f64::consts::PI));
        Self(degrees.0.with_primal(Primitive::to_degrees(self.0.primal())))
    }

    /// Order of all values, NaN and the two zeros included.
    #[inline]
    #[must_use]
    pub fn total_cmp(&self, other: &Self) -> Ordering {
        Primitive::total_cmp(self.0.primal(), other.0.primal())
    }

    /// Whether the value is neither zero, subnormal, infinite nor NaN.
    #[inline]
    #[must_use]
    pub fn is_normal(self) -> bool {
        Primitive::is_normal(self.0.primal())
    }

    /// Whether the value is subnormal.
    #[inline]
    #[must_use]
    pub fn is_subnormal(self) -> bool {
        Primitive::is_subnormal(self.0.primal())
    }

    /// Whether the value is NaN.
    #[inline]
    #[must_use]
    pub fn is_nan(self) -> bool {
        Primitive::is_nan(self.0.primal())
    }

    /// Whether the value is finite.
    #[inline]
    #[must_use]
    pub fn is_finite(self) -> bool {
        Primitive::is_finite(self.0.primal())
    }

    /// Whether the value is infinite.
    #[inline]
    #[must_use]
    pub fn is_infinite(self) -> bool {
        !self.is_finite() && !self.is_nan()
    }

    /// Whether the sign bit is unset.
    #[inline]
    #[must_use]
    pub fn is_sign_positive(self) -> bool {
        !self.is_sign_negative()
    }

    /// Whether the sign bit is set.
    #[inline]
    #[must_use]
    pub fn is_sign_negative(self) -> bool {
        Primitive::is_sign_negative(self.0.primal())
    }
}
