//! The numbers that a program is evaluated over: doubles and singles as rustc computes them, duals for
//! derivatives, numbers of two doubles for difference quotients.

use double_double::DoubleDouble;
use num_dual::{Dual2SVec64, DualNum};

/// Entries of (q, v) at most.
pub const VARIABLES: usize = 6;

/// num-dual's number with gradient and Hessian by all of (q, v).
pub type Dual = Dual2SVec64<VARIABLES>;

/// What an evaluation needs of a number.
pub trait Number: Copy {
    fn constant(value: f64) -> Self;
    /// As a double.
    fn value(self) -> f64;
    fn less(self, other: Self) -> bool;
    fn equal(self, other: Self) -> bool;
    fn plus(self, other: Self) -> Self;
    fn minus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    fn over(self, other: Self) -> Self;
    fn negated(self) -> Self;
    /// A method without arguments.
    fn function(self, name: &str) -> Self;
    /// `powf`, `atan2`, `hypot`, `copysign`, `log`.
    fn pair(self, name: &str, other: Self) -> Self;
    fn mul_add(self, a: Self, b: Self) -> Self;
    fn powi(self, n: i32) -> Self;
    /// Largest size of the value and its derivatives.
    fn size(self) -> f64 {
        self.value().abs()
    }
    /// About how far (q, v) is from where the two are equal, if it is known.
    fn distance(self, other: Self) -> f64 {
        let _ = other;
        f64::INFINITY
    }
}

/// Methods that machine numbers and num-dual's have under the same name.
macro_rules! elementary {
    ($name:expr, $x:expr) => {
        elementary!($name, $x; recip exp exp2 exp_m1 ln log2 log10 ln_1p sin cos tan asin acos atan sinh cosh asinh
            acosh atanh sqrt cbrt)
    };
    ($name:expr, $x:expr; $($function:ident)*) => {
        match $name {
            $(stringify!($function) => $x.$function(),)*
            name => unreachable!("the generator writes no method `{name}`"),
        }
    };
}

macro_rules! machine_number {
    ($scalar:ident) => {
        impl Number for $scalar {
            fn constant(value: f64) -> Self {
                value as $scalar
            }
            fn value(self) -> f64 {
                f64::from(self)
            }
            fn less(self, other: Self) -> bool {
                self < other
            }
            fn equal(self, other: Self) -> bool {
                self == other
            }
            fn plus(self, other: Self) -> Self {
                self + other
            }
            fn minus(self, other: Self) -> Self {
                self - other
            }
            fn times(self, other: Self) -> Self {
                self * other
            }
            fn over(self, other: Self) -> Self {
                self / other
            }
            fn negated(self) -> Self {
                -self
            }
            fn function(self, name: &str) -> Self {
                match name {
                    "tanh" => self.tanh(),
                    "abs" => self.abs(),
                    "signum" => self.signum(),
                    "to_radians" => self.to_radians(),
                    "to_degrees" => self.to_degrees(),
                    name => elementary!(name, self),
                }
            }
            fn pair(self, name: &str, other: Self) -> Self {
                match name {
                    "powf" => self.powf(other),
                    "atan2" => self.atan2(other),
                    "hypot" => self.hypot(other),
                    "copysign" => self.copysign(other),
                    "log" => self.log(other),
                    "min" => self.min(other),
                    "max" => self.max(other),
                    _ => unreachable!("the generator writes no method `{name}`"),
                }
            }
            fn mul_add(self, a: Self, b: Self) -> Self {
                $scalar::mul_add(self, a, b)
            }
            fn powi(self, n: i32) -> Self {
                $scalar::powi(self, n)
            }
        }
    };
}

machine_number!(f64);
machine_number!(f32);

/// `min` and `max` by the values, as Rust has them.
fn extremum<S: Number>(name: &str, a: S, b: S) -> S {
    let takes_other = if name == "min" { b.less(a) } else { a.less(b) };
    if takes_other || a.value().is_nan() { b } else { a }
}

impl Number for DoubleDouble {
    fn constant(value: f64) -> Self {
        value.into()
    }
    fn value(self) -> f64 {
        self.high
    }
    fn less(self, other: Self) -> bool {
        DoubleDouble::less(self, other)
    }
    fn equal(self, other: Self) -> bool {
        self.high == other.high && self.low == other.low
    }
    fn plus(self, other: Self) -> Self {
        self + other
    }
    fn minus(self, other: Self) -> Self {
        self - other
    }
    fn times(self, other: Self) -> Self {
        self * other
    }
    fn over(self, other: Self) -> Self {
        self / other
    }
    fn negated(self) -> Self {
        -self
    }
    fn function(self, name: &str) -> Self {
        let one = Self::from(1.0);
        match name {
            "recip" => one / self,
            "exp" => self.exp(),
            "exp2" => self.exp2(),
            "exp_m1" => self.exp_m1(),
            "ln" => self.ln(),
            "log2" => self.log2(),
            "log10" => self.log10(),
            "ln_1p" => self.ln_1p(),
            "sin" => self.sin_cos().0,
            "cos" => self.sin_cos().1,
            "tan" => {
                let (sine, cosine) = self.sin_cos();
                sine / cosine
            }
            "asin" => (self / ((one - self) * (one + self)).sqrt()).atan(),
            "acos" => ((one - self) * (one + self)).sqrt().atan2(self),
            "atan" => self.atan(),
            "sinh" => self.sinh(),
            "cosh" => self.cosh(),
            "tanh" => self.tanh(),
            "asinh" => self.asinh(),
            "acosh" => (self + (self * self - one).sqrt()).ln(),
            "atanh" => (self * Self::from(2.0) / (one - self)).ln_1p() * Self::from(0.5),
            "sqrt" => self.sqrt(),
            "cbrt" => self.cbrt(),
            "abs" => self.abs(),
            "signum" => self.high.signum().into(),
            // The factor is a double, as it is in the standard library.
            "to_radians" => self * (std::f64::consts::PI / 180.0).into(),
            "to_degrees" => self * (180.0 / std::f64::consts::PI).into(),
            _ => unreachable!("the generator writes no method `{name}`"),
        }
    }
    fn pair(self, name: &str, other: Self) -> Self {
        match name {
            "powf" => self.powf(other),
            "atan2" => self.atan2(other),
            "hypot" => (self * self + other * other).sqrt(),
            "copysign" => {
                if self.high.is_sign_negative() == other.high.is_sign_negative() {
                    self
                } else {
                    -self
                }
            }
            "log" => self.ln() / other.ln(),
            "min" | "max" => extremum(name, self, other),
            _ => unreachable!("the generator writes no method `{name}`"),
        }
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    fn powi(self, n: i32) -> Self {
        DoubleDouble::powi(self, n)
    }
}

impl Number for Dual {
    fn constant(value: f64) -> Self {
        value.into()
    }
    fn value(self) -> f64 {
        self.re
    }
    fn less(self, other: Self) -> bool {
        self.re < other.re
    }
    fn equal(self, other: Self) -> bool {
        self.re == other.re
    }
    fn plus(self, other: Self) -> Self {
        self + other
    }
    fn minus(self, other: Self) -> Self {
        self - other
    }
    fn times(self, other: Self) -> Self {
        self * other
    }
    fn over(self, other: Self) -> Self {
        self / other
    }
    fn negated(self) -> Self {
        -self
    }
    fn function(self, name: &str) -> Self {
        match name {
            // num-dual's own loses the derivative beyond |x| ≈ 20.
            "tanh" => {
                let sign = self.re.signum();
                let twice = self * (-2.0 * sign);
                -twice.exp_m1() / (twice.exp() + 1.0) * sign
            }
            "abs" => {
                if self.re.is_sign_negative() {
                    -self
                } else {
                    self
                }
            }
            "signum" => self.re.signum().into(),
            "to_radians" => self * (std::f64::consts::PI / 180.0),
            "to_degrees" => self * (180.0 / std::f64::consts::PI),
            name => elementary!(name, self),
        }
    }
    fn pair(self, name: &str, other: Self) -> Self {
        match name {
            "powf" => {
                let constant = other.v1.0.is_none() && other.v2.0.is_none();
                let mut power =
                    if constant { DualNum::powf(&self, other.re) } else { (self.ln() * other).exp() };
                power.re = self.re.powf(other.re);
                power
            }
            "atan2" => {
                let (y, x) = (self, other);
                let angle = y.re.atan2(x.re);
                let quotient = if x.re.abs() >= y.re.abs() { (y / x).atan() } else { -(x / y).atan() };
                quotient + (angle - quotient.re)
            }
            "hypot" => (self * self + other * other).sqrt(),
            "copysign" => {
                if self.re.is_sign_negative() == other.re.is_sign_negative() {
                    self
                } else {
                    -self
                }
            }
            "log" => self.ln() / other.ln(),
            "min" | "max" => extremum(name, self, other),
            _ => unreachable!("the generator writes no method `{name}`"),
        }
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    fn powi(self, n: i32) -> Self {
        DualNum::powi(&self, n)
    }
    fn size(self) -> f64 {
        let mut size = self.re.abs();
        for part in [self.v1.0.as_ref().map(|v| v.amax()), self.v2.0.as_ref().map(|m| m.amax())] {
            size = size.max(part.unwrap_or(0.0));
        }
        size
    }
    fn distance(self, other: Self) -> f64 {
        let difference = self - other;
        let slope = difference.v1.0.map_or(0.0, |gradient| gradient.norm());
        if slope == 0.0 { f64::INFINITY } else { difference.re.abs() / slope }
    }
}
