//! Sums of two `f64`: about 31 digits (T. J. Dekker, A floating-point technique for extending the available
//! precision, Numerische Mathematik 18, 1971), with the elementary functions that a body may call.
//!
//! Built optimised for the tests, too: they spend most of their time in it. What is inlined into a program
//! that is not would be compiled there.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// high + low, |low| ≤ half an ulp of high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble {
    /// The nearest `f64`.
    pub high: f64,
    /// What it lacks.
    pub low: f64,
}

const LN_2: DoubleDouble = DoubleDouble { high: std::f64::consts::LN_2, low: 2.3190468138462996e-17 };
const LN_10: DoubleDouble = DoubleDouble { high: std::f64::consts::LN_10, low: -2.1707562233822494e-16 };
const HALF_PI: DoubleDouble = DoubleDouble { high: std::f64::consts::FRAC_PI_2, low: 6.123233995736766e-17 };

/// Terms of the series of sinh beyond this are below the last digit: its arguments are below ½.
const TERMS: u32 = 30;

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

/// a + b exactly, where |a| ≥ |b|.
fn quick_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let low = if high.is_finite() { b - (high - a) } else { 0.0 };
    DoubleDouble { high, low }
}

/// a + b exactly.
fn sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let part = high - a;
    let low = if high.is_finite() { (a - (high - part)) + (b - part) } else { 0.0 };
    DoubleDouble { high, low }
}

/// a b exactly.
fn product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    let low = if high.is_finite() { a.mul_add(b, -high) } else { 0.0 };
    DoubleDouble { high, low }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[cfg_attr(debug_assertions, inline(never))]
    fn add(self, other: Self) -> Self {
        let (high, low) = (sum(self.high, other.high), sum(self.low, other.low));
        let first = quick_sum(high.high, high.low + low.high);
        quick_sum(first.high, first.low + low.low)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    #[cfg_attr(debug_assertions, inline(never))]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[cfg_attr(debug_assertions, inline(never))]
    fn mul(self, other: Self) -> Self {
        let main = product(self.high, other.high);
        quick_sum(main.high, main.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    #[cfg_attr(debug_assertions, inline(never))]
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        if !first.is_finite() || !other.high.is_finite() {
            return first.into();
        }
        let rest = self - other * first.into();
        let second = rest.high / other.high;
        let rest = rest - other * second.into();
        let third = rest.high / other.high;
        quick_sum(first, second) + third.into()
    }
}

impl DoubleDouble {
    /// 0.
    pub const ZERO: Self = Self { high: 0.0, low: 0.0 };

    /// An `f64`, exactly.
    pub const fn new(high: f64) -> Self {
        Self { high, low: 0.0 }
    }

    /// Whether it is a number.
    pub fn is_finite(self) -> bool {
        self.high.is_finite()
    }

    /// The product with a power of 2.
    fn scaled(self, by: f64) -> Self {
        Self { high: self.high * by, low: self.low * by }
    }

    /// self < other.
    pub fn less(self, other: Self) -> bool {
        self.high < other.high || (self.high == other.high && self.low < other.low)
    }

    /// |x|.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.high.is_sign_negative() { -self } else { self }
    }

    /// √x.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let first = self.high.sqrt();
        if first == 0.0 || !first.is_finite() {
            return first.into();
        }
        let root = Self::from(first);
        root + (self - root * root).scaled(0.5) / root
    }

    /// ∛x.
    #[must_use]
    pub fn cbrt(self) -> Self {
        let first = self.high.cbrt();
        if first == 0.0 || !first.is_finite() {
            return first.into();
        }
        let root = Self::from(first);
        root - (root * root * root - self) / (root * root * Self::from(3.0))
    }

    /// eˣ: the argument less a multiple of ln 2, over 2⁹, by Taylor's series.
    #[must_use]
    pub fn exp(self) -> Self {
        if self.high.is_nan() || self.high.abs() >= 745.0 {
            return Self::new(self.high.exp());
        }
        let doublings = (self.high / LN_2.high).round();
        let reduced = (self - LN_2 * Self::new(doublings)).scaled(1.0 / 512.0);
        // e^x − 1, squared nine times as y ← y(y + 2).
        let (mut term, mut sum) = (reduced, reduced);
        for k in 2..12 {
            term = term * reduced / Self::new(f64::from(k));
            sum = sum + term;
        }
        for _ in 0..9 {
            sum = sum * (sum + Self::new(2.0));
        }
        let halves = [(0.5 * doublings).floor(), doublings - (0.5 * doublings).floor()];
        (sum + Self::new(1.0)).scaled(halves[0].exp2()).scaled(halves[1].exp2())
    }

    /// ln x.
    #[must_use]
    pub fn ln(self) -> Self {
        let first = self.high.ln();
        if !first.is_finite() {
            return first.into();
        }
        // Newton's method for exp(y) = x, twice, of which the second step is exact to 32 digits.
        (0..2).fold(first.into(), |y: Self, _| y + self * (-y).exp() - 1.0.into())
    }

    /// sin x and cos x: the argument less a multiple of π/2, over 2³, by Taylor's series.
    pub fn sin_cos(self) -> (Self, Self) {
        // Farther out not even the quadrant is known to twice the digits.
        if self.high.is_nan() || self.high.abs() >= 1e15 {
            return (self.high.sin().into(), self.high.cos().into());
        }
        let quarters = (self.high / HALF_PI.high).round();
        let reduced = (self - HALF_PI * Self::new(quarters)).scaled(0.125);
        let square = reduced * reduced;
        // sin and 1 − cos.
        let (mut sine, mut versine) = (reduced, square.scaled(0.5));
        let (mut odd, mut even) = (sine, versine);
        for k in 1..14 {
            let k = f64::from(k);
            odd = -odd * square / Self::new((2.0 * k) * (2.0 * k + 1.0));
            even = -even * square / Self::new((2.0 * k + 1.0) * (2.0 * k + 2.0));
            (sine, versine) = (sine + odd, versine + even);
        }
        for _ in 0..3 {
            let cosine = Self::new(1.0) - versine;
            versine = sine * sine * Self::new(2.0);
            sine = sine * cosine * Self::new(2.0);
        }
        let cosine = Self::new(1.0) - versine;
        match quarters.rem_euclid(4.0) as u8 {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        }
    }

    /// arctan x.
    #[must_use]
    pub fn atan(self) -> Self {
        let first = self.high.atan();
        if !first.is_finite() || self.high.is_infinite() {
            return if self.high > 0.0 {
                HALF_PI
            } else if self.high < 0.0 {
                -HALF_PI
            } else {
                first.into()
            };
        }
        // Newton's method for tan(y) = x: y + cos y (x cos y − sin y), twice.
        (0..2).fold(first.into(), |y: Self, _| {
            let (sine, cosine) = y.sin_cos();
            y + cosine * (self * cosine - sine)
        })
    }

    /// sinh x.
    #[must_use]
    pub fn sinh(self) -> Self {
        if self.high.abs() < 0.3 {
            let square = self * self;
            let (mut term, mut total) = (self, self);
            for k in 1..TERMS {
                term = term * square / f64::from(2 * k * (2 * k + 1)).into();
                total = total + term;
            }
            return total;
        }
        let e = self.exp();
        (e - Self::from(1.0) / e).scaled(0.5)
    }

    /// cosh x.
    #[must_use]
    pub fn cosh(self) -> Self {
        let e = self.exp();
        (e + Self::from(1.0) / e).scaled(0.5)
    }

    /// tanh x.
    #[must_use]
    pub fn tanh(self) -> Self {
        // 1 to 32 digits.
        if self.high.abs() > 300.0 {
            return self.high.signum().into();
        }
        self.sinh() / self.cosh()
    }

    /// eˣ − 1, with all digits near 0.
    #[must_use]
    pub fn exp_m1(self) -> Self {
        // eˣ − 1 = 2 eˣᐟ² sinh(x/2).
        let half = self.scaled(0.5);
        half.exp() * half.sinh().scaled(2.0)
    }

    /// ln(1 + x), with all digits near 0.
    #[must_use]
    pub fn ln_1p(self) -> Self {
        let one = Self::from(1.0);
        // Newton's method for eʸ − 1 = x, which keeps the digits near 0.
        let first = self.high.ln_1p();
        if !first.is_finite() {
            return first.into();
        }
        (0..2).fold(first.into(), |y: Self, _| y + (self - y.exp_m1()) / (y.exp_m1() + one))
    }

    /// arsinh x.
    #[must_use]
    pub fn asinh(self) -> Self {
        let size = self.abs();
        let root = (size * size + 1.0.into()).sqrt();
        // |x| + x²/(1 + √(x² + 1)), without cancellation.
        let result = (size + size * size / (root + 1.0.into())).ln_1p();
        if self.high.is_sign_negative() { -result } else { result }
    }

    /// xⁿ.
    #[must_use]
    pub fn powi(self, n: i32) -> Self {
        let mut total = Self::from(1.0);
        let (mut base, mut rest) = (self, n.unsigned_abs());
        while rest > 0 {
            if rest % 2 == 1 {
                total = total * base;
            }
            base = base * base;
            rest /= 2;
        }
        if n < 0 { Self::from(1.0) / total } else { total }
    }

    /// x to the power `exponent`.
    #[must_use]
    pub fn powf(self, exponent: Self) -> Self {
        let plain = self.high.powf(exponent.high);
        if self.high <= 0.0 || !plain.is_finite() || plain == 0.0 {
            return plain.into();
        }
        (self.ln() * exponent).exp()
    }

    /// The angle of (x, self).
    #[must_use]
    pub fn atan2(self, x: Self) -> Self {
        let plain = self.high.atan2(x.high);
        if !plain.is_finite() || (self.high == 0.0 && x.high == 0.0) {
            return plain.into();
        }
        let main = if x.high.abs() >= self.high.abs() { (self / x).atan() } else { -(x / self).atan() };
        // The quadrant, a multiple of π/2.
        main + HALF_PI * ((plain - main.high) / HALF_PI.high).round().into()
    }

    /// log₂ x.
    #[must_use]
    pub fn log2(self) -> Self {
        self.ln() / LN_2
    }

    /// log₁₀ x.
    #[must_use]
    pub fn log10(self) -> Self {
        self.ln() / LN_10
    }

    /// 2ˣ.
    #[must_use]
    pub fn exp2(self) -> Self {
        (self * LN_2).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_close(a: DoubleDouble, b: DoubleDouble) -> bool {
        (a - b).high.abs() <= 1e-29 * b.high.abs().max(1.0)
    }

    #[test]
    fn carries_twice_the_digits() {
        let one = DoubleDouble::new(1.0);
        let third = one / DoubleDouble::new(3.0);
        assert!(is_close(third * DoubleDouble::new(3.0), one) && third.low != 0.0);
        let root = DoubleDouble::new(2.0).sqrt();
        assert!(is_close(root * root, DoubleDouble::new(2.0)));
        // Published digits of e and of sin 1, less their first 16.
        let e = DoubleDouble { high: std::f64::consts::E, low: 1.445_646_891_729_250_2e-16 };
        assert!(is_close(one.exp(), e));
        for x in [-300.0, -3.3, 1e-9, 0.7, 12.5, 290.0] {
            let x = DoubleDouble::new(x);
            assert!(is_close(x.exp() * (-x).exp(), one), "{x:?}");
        }
        for x in [-1e6, -3.3, 1e-9, 0.7, 12.5] {
            let (sine, cosine) = DoubleDouble::new(x).sin_cos();
            assert!(is_close(sine * sine + cosine * cosine, one), "{x}");
            assert!((sine.high - x.sin()).abs() < 1e-15 && (cosine.high - x.cos()).abs() < 1e-15, "{x}");
            let (twice, _) = DoubleDouble::new(2.0 * x).sin_cos();
            assert!(is_close(twice, sine * cosine * DoubleDouble::new(2.0)), "{x}");
        }
    }
}
