//! Sums of two `f64`, evaluated when the program is compiled: about 31 digits for the coefficients of a
//! method.
//!
//! T. J. Dekker, *A floating-point technique for extending the available precision*, Numerische Mathematik 18
//! (1971). Own code because it has to be `const`.

/// high + low, |low| at most half the last place of high.
#[derive(Clone, Copy, Debug)]
pub(super) struct Double {
    pub(super) high: f64,
    low: f64,
}

/// a + b and what it loses, for any a and b.
const fn two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    let share = high - a;
    Double { high, low: (a - (high - share)) + (b - share) }
}

/// a in two halves of 26 bits.
const fn halves(a: f64) -> (f64, f64) {
    let shifted = 134_217_729.0 * a; // 2²⁷ + 1
    let high = shifted - (shifted - a);
    (high, a - high)
}

/// a b and what it loses.
const fn two_product(a: f64, b: f64) -> Double {
    let high = a * b;
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    Double { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
}

impl Double {
    pub(super) const fn new(high: f64) -> Self {
        Self { high, low: 0.0 }
    }

    pub(super) const fn plus(self, other: Self) -> Self {
        let sum = two_sum(self.high, other.high);
        two_sum(sum.high, sum.low + (self.low + other.low))
    }

    pub(super) const fn negated(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }

    pub(super) const fn minus(self, other: Self) -> Self {
        self.plus(other.negated())
    }

    pub(super) const fn times(self, other: Self) -> Self {
        let product = two_product(self.high, other.high);
        two_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }

    pub(super) const fn over(self, other: Self) -> Self {
        let first = Self::new(self.high / other.high);
        let rest = self.minus(first.times(other));
        let second = Self::new(rest.high / other.high);
        let rest = rest.minus(second.times(other));
        first.plus(second).plus(Self::new(rest.high / other.high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn carries_twice_the_digits() {
        let third = Double::new(1.0).over(Double::new(3.0));
        let rest = third.times(Double::new(3.0)).minus(Double::new(1.0));
        assert!(rest.high.abs() < 1e-31, "{rest:?}");
        // √2 by Newton: x² − 2 stays at twice the digits.
        let mut root = Double::new(core::f64::consts::SQRT_2);
        // Positive control: the f64 itself is off in its 17th digit.
        assert!(root.times(root).minus(Double::new(2.0)).high.abs() > 1e-17);
        for _ in 0..2 {
            root = root.plus(Double::new(2.0).over(root)).times(Double::new(0.5));
        }
        assert!(root.times(root).minus(Double::new(2.0)).high.abs() < 1e-30);
    }
}
