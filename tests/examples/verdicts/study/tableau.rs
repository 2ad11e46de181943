//! Gauss–Legendre collocation in twice the precision: nodes as roots of Legendre polynomials, the rest by
//! integrating Lagrange polynomials, exactly up to rounding.

use double_double::DoubleDouble;

/// Weights b and the matrix a of the collocation.
#[derive(Clone, Debug)]
pub struct Tableau {
    /// aᵢⱼ, row by row.
    pub a: Vec<Vec<DoubleDouble>>,
    /// bⱼ.
    pub b: Vec<DoubleDouble>,
}

fn number(value: f64) -> DoubleDouble {
    DoubleDouble::new(value)
}

/// P_n and its slope, by the recurrence.
fn legendre(n: usize, x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let (mut before, mut at) = (number(1.0), x);
    for k in 2..=n {
        let k = k as f64;
        let next = (number(2.0 * k - 1.0) * x * at - number(k - 1.0) * before) / number(k);
        (before, at) = (at, next);
    }
    let slope = number(n as f64) * (before - x * at) / (number(1.0) - x * x);
    (at, slope)
}

/// The nodes cᵢ, ascending.
fn nodes(s: usize) -> Vec<DoubleDouble> {
    let node = |i: usize| {
        let angle = std::f64::consts::PI * (i as f64 + 0.75) / (s as f64 + 0.5);
        let mut x = number(-angle.cos());
        for _ in 0..8 {
            let (value, slope) = legendre(s, x);
            x = x - value / slope;
        }
        (x + number(1.0)) * number(0.5)
    };
    (0..s).map(node).collect()
}

impl Tableau {
    /// Of `s` stages, s ≥ 1.
    pub fn new(s: usize) -> Self {
        let c = nodes(s);
        // ℓⱼ as powers of t, integrated from 0 to cᵢ or 1.
        let powers: Vec<Vec<DoubleDouble>> = (0..s)
            .map(|j| {
                let mut polynomial = vec![number(1.0)];
                for k in (0..s).filter(|&k| k != j) {
                    let (shift, scale) = (c[k], c[j] - c[k]);
                    let mut product = vec![number(0.0); polynomial.len() + 1];
                    for (i, &factor) in polynomial.iter().enumerate() {
                        product[i + 1] = product[i + 1] + factor / scale;
                        product[i] = product[i] - factor * shift / scale;
                    }
                    polynomial = product;
                }
                polynomial
            })
            .collect();
        let integral = |polynomial: &[DoubleDouble], to: DoubleDouble| {
            let mut power = number(1.0);
            let mut sum = number(0.0);
            for (k, &factor) in polynomial.iter().enumerate() {
                power = power * to;
                sum = sum + factor * power / number(k as f64 + 1.0);
            }
            sum
        };
        let a = c.iter().map(|&c| powers.iter().map(|l| integral(l, c)).collect()).collect();
        let b = powers.iter().map(|l| integral(l, number(1.0))).collect();
        Self { a, b }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σⱼ aᵢⱼ cⱼᵏ = cᵢᵏ⁺¹/(k + 1) for k < s, and the weights integrate t²ˢ⁻¹.
    #[test]
    fn collocation_conditions_hold_to_twice_the_precision() {
        for s in 1..=8 {
            let (Tableau { a, b }, c) = (Tableau::new(s), nodes(s));
            let power = |x: DoubleDouble, k: usize| (0..k).fold(number(1.0), |power, _| power * x);
            for k in 0..2 * s {
                let moment = (0..s).fold(number(0.0), |sum, j| sum + b[j] * power(c[j], k));
                assert!((moment - number(1.0) / number(k as f64 + 1.0)).high.abs() < 1e-26, "{s} {k}");
                for i in (0..s).filter(|_| k < s) {
                    let moment = (0..s).fold(number(0.0), |sum, j| sum + a[i][j] * power(c[j], k));
                    let expected = power(c[i], k + 1) / number(k as f64 + 1.0);
                    assert!((moment - expected).high.abs() < 1e-26, "{s} {i} {k}");
                }
            }
        }
    }
}
