//! A number of twice the precision, and what `f64` arithmetic may lose of it: running error analysis (J. H.
//! Wilkinson, 1963).

use std::ops::{Add, Div, Mul, Neg, Sub};

use double_double::DoubleDouble;

/// u = ε/2, the relative error of one rounding.
const UNIT: f64 = 0.5 * f64::EPSILON;

/// A value, and to first order a bound of the error with which `f64` knows it, if inputs are known to u and
/// every operation rounds.
#[derive(Clone, Copy, Debug)]
pub struct Rounded {
    /// The value of the formula at the inputs as they are.
    pub value: DoubleDouble,
    /// The bound.
    pub error: f64,
}

impl Rounded {
    /// 0, known exactly.
    pub const ZERO: Self = Self { value: DoubleDouble::ZERO, error: 0.0 };

    /// A constant of the formula, exact.
    pub const fn exact(value: f64) -> Self {
        Self { value: DoubleDouble::new(value), error: 0.0 }
    }

    /// A number that the computation is given, or returns: known to u.
    pub fn input(value: f64) -> Self {
        Self { value: DoubleDouble::new(value), error: UNIT * value.abs() }
    }

    /// A constant of the method, such as a node: known to u.
    pub fn coefficient(value: DoubleDouble) -> Self {
        Self { value, error: UNIT * value.high.abs() }
    }

    /// √x.
    pub fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        Self::made(value, 0.5 * self.error / value.high)
    }

    /// eˣ.
    pub fn exp(self) -> Self {
        let value = self.value.exp();
        Self::made(value, self.error * value.high)
    }

    /// sin x and cos x.
    pub fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (Self::made(sine, self.error * cosine.high.abs()), Self::made(cosine, self.error * sine.high.abs()))
    }

    /// x², x⁴, …: xⁿ by products, n ≥ 1.
    pub fn power(self, n: u32) -> Self {
        (1..n).fold(self, |power, _| power * self)
    }

    /// 1/x.
    pub fn recip(self) -> Self {
        Self::exact(1.0) / self
    }

    /// The value is rounded once more; below the normal numbers by more than u.
    fn made(value: DoubleDouble, carried: f64) -> Self {
        Self { value, error: carried + UNIT * value.high.abs() + f64::MIN_POSITIVE * f64::EPSILON }
    }

    /// |value| as an `f64`.
    pub fn size(self) -> f64 {
        self.value.high.abs()
    }
}

impl Neg for Rounded {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, ..self }
    }
}

impl Add for Rounded {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::made(self.value + other.value, self.error + other.error)
    }
}

impl Sub for Rounded {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Rounded {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::made(self.value * other.value, self.size() * other.error + other.size() * self.error)
    }
}

impl Mul<f64> for Rounded {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        self * Self::exact(other)
    }
}

impl Add<f64> for Rounded {
    type Output = Self;
    fn add(self, other: f64) -> Self {
        self + Self::exact(other)
    }
}

impl Div for Rounded {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self::made(value, (self.error + value.high.abs() * other.error) / other.size())
    }
}

impl std::iter::Sum for Rounded {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(Self::ZERO, Add::add)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_bounds_and_is_no_looser_than_it_must_be() {
        let mut tightest = 0.0_f64;
        for k in 1..2000 {
            let x = 0.37 * f64::from(k);
            // (x² − 1)/(x + 3) sin x, in f64 and here.
            let plain = (x * x - 1.0) / (x + 3.0) * x.sin();
            let at = Rounded { error: 0.0, ..Rounded::input(x) };
            let of = (at * at + -1.0) / (at + 3.0) * at.sin_cos().0;
            let off = (of.value - DoubleDouble::new(plain)).high.abs();
            assert!(off <= of.error, "{x}: {off:e} {:e}", of.error);
            tightest = tightest.max(off / of.error);
        }
        assert!(tightest > 0.2, "{tightest}");
    }
}
