//! Polynomials on one step by their values at its ends and at nodes between: as Bernstein polynomials, with
//! what their values at the nodes say of them at once.
//!
//! ```text
//! p(τ) = Σ_k β_k C(n,k) τᵏ(1 − τ)ⁿ⁻ᵏ,   β = T p(τ_i),   ℓ_i(τ) = Π_{j≠i} ((1 − τ_j) τ − τ_j (1 − τ))/(τ_i − τ_j)
//! ```
//!
//! The product of the factors has terms of one sign in every coefficient, so that T is exact to rounding.

use crate::rules::Gauss;

/// The most values that make a polynomial: at eight stages and both ends.
pub(super) const MOST: usize = 10;

/// Nodes of polynomials of degree n, 0 and 1 among them.
pub(super) struct Nodes {
    /// The degree n.
    pub(super) degree: usize,
    /// 0 = τ_0 < … < τ_n = 1.
    pub(super) shares: [f64; MOST],
    /// T.
    coefficients: [[f64; MOST]; MOST],
    /// The largest Σ_j |T_ij|.
    norm: f64,
    /// Rows that give the last three coefficients in Legendre polynomials from β: of degree n, n − 1, n − 2.
    tails: [[f64; MOST]; 3],
    /// Above the Lebesgue constant max_τ Σ |ℓ_i(τ)|.
    pub(super) lebesgue: f64,
}

/// C(n, k).
const fn binomial(n: usize, k: usize) -> f64 {
    let (mut value, mut i) = (1.0, 0);
    while i < k {
        value = value * (n - i) as f64 / (i + 1) as f64;
        i += 1;
    }
    value
}

/// The nodes of the cubic, with two between its ends, and of the Gauss rules of three to eight stages.
static OF_STAGES: [Nodes; 7] = [
    Nodes::new(&Gauss::<2>::NODES),
    Nodes::new(&Gauss::<3>::NODES),
    Nodes::new(&Gauss::<4>::NODES),
    Nodes::new(&Gauss::<5>::NODES),
    Nodes::new(&Gauss::<6>::NODES),
    Nodes::new(&Gauss::<7>::NODES),
    Nodes::new(&Gauss::<8>::NODES),
];

impl Nodes {
    /// The nodes of the Gauss rule whose nodes `interior` are.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn of(interior: &'static [f64]) -> &'static Self {
        OF_STAGES.get(interior.len().wrapping_sub(2)).unwrap_or(&OF_STAGES[0])
    }

    /// The nodes `interior`, ascending, at most eight, with both ends.
    pub(super) const fn new(interior: &[f64]) -> Self {
        assert!(interior.len() + 2 <= MOST, "polynomials have at most ten values");
        let degree = interior.len() + 1;
        let mut shares = [0.0; MOST];
        shares[degree] = 1.0;
        let mut i = 1;
        while i < degree {
            shares[i] = interior[i - 1];
            i += 1;
        }
        let mut nodes = Self {
            degree,
            shares,
            coefficients: [[0.0; MOST]; MOST],
            norm: 0.0,
            tails: [[0.0; MOST]; 3],
            lebesgue: 0.0,
        };
        nodes.set_coefficients();
        nodes.set_tails();
        nodes.set_lebesgue();
        nodes
    }

    const fn set_coefficients(&mut self) {
        let n = self.degree;
        let mut i = 0;
        while i <= n {
            // ℓ_i in τᵏ(1 − τ)ⁿ⁻ᵏ.
            let mut product = [0.0; MOST];
            product[0] = 1.0;
            let (mut j, mut factors) = (0, 0);
            while j <= n {
                if j != i {
                    let slope = self.shares[i] - self.shares[j];
                    let (low, high) = (-self.shares[j] / slope, (1.0 - self.shares[j]) / slope);
                    factors += 1;
                    let mut k = factors;
                    while k > 0 {
                        product[k] = product[k] * low + product[k - 1] * high;
                        k -= 1;
                    }
                    product[0] *= low;
                }
                j += 1;
            }
            let mut k = 0;
            while k <= n {
                self.coefficients[k][i] = product[k] / binomial(n, k);
                k += 1;
            }
            i += 1;
        }
        let mut k = 0;
        while k <= n {
            let (mut sum, mut i) = (0.0, 0);
            while i <= n {
                sum += self.coefficients[k][i].abs();
                i += 1;
            }
            if sum > self.norm {
                self.norm = sum;
            }
            k += 1;
        }
    }

    /// (2d + 1) ∫ p P_d(2τ − 1) dτ, with P_d = Σ_i (−1)^{d+i} C(d,i) of the Bernstein polynomial i of degree
    /// d.
    const fn set_tails(&mut self) {
        let n = self.degree;
        let mut row = 0;
        while row < 3 && row <= n {
            let d = n - row;
            let mut k = 0;
            while k <= n {
                let (mut sum, mut i) = (0.0, 0);
                while i <= d {
                    let term = binomial(d, i) * binomial(d, i) / binomial(n + d, i + k);
                    sum += if (d + i).is_multiple_of(2) { term } else { -term };
                    i += 1;
                }
                self.tails[row][k] = sum * binomial(n, k) * (2 * d + 1) as f64 / (n + d + 1) as f64;
                k += 1;
            }
            row += 1;
        }
    }

    /// The largest value on a fine grid, and 2 % for what lies between.
    const fn set_lebesgue(&mut self) {
        const POINTS: usize = 250;
        let n = self.degree;
        let mut point = 0;
        while point <= POINTS {
            let at = point as f64 / POINTS as f64;
            let (mut sum, mut i) = (0.0, 0);
            while i <= n {
                let (mut product, mut j) = (1.0_f64, 0);
                while j <= n {
                    if j != i {
                        product *= (at - self.shares[j]) / (self.shares[i] - self.shares[j]);
                    }
                    j += 1;
                }
                sum += product.abs();
                i += 1;
            }
            if sum > self.lebesgue {
                self.lebesgue = sum;
            }
            point += 1;
        }
        self.lebesgue *= 1.02;
    }

    /// The polynomial through `values` at the nodes.
    pub(super) fn polynomial(&self, values: &[f64; MOST]) -> Bernstein {
        let n = self.degree;
        let mut beta = [0.0; MOST];
        for (k, (beta, row)) in beta.iter_mut().zip(&self.coefficients).enumerate().take(n + 1) {
            *beta = match k {
                0 => values[0],
                k if k == n => values[k],
                _ => row.iter().zip(values).map(|(factor, value)| factor * value).sum(),
            };
        }
        Bernstein { degree: n, beta }
    }

    /// The last coefficients in Legendre polynomials, of degree n, n − 1 and n − 2.
    pub(super) fn tails(&self, of: &Bernstein) -> [f64; 3] {
        let coefficient = |row: &[f64; MOST]| row.iter().zip(&of.beta).map(|(a, b)| a * b).sum::<f64>();
        [coefficient(&self.tails[0]), coefficient(&self.tails[1]), coefficient(&self.tails[2])]
    }

    /// The rounding error of β, where no value is larger than `size`.
    pub(super) fn rounding(&self, epsilon: f64, size: f64) -> f64 {
        2.0 * epsilon * self.norm * size
    }
}

/// A polynomial on [0, 1] by its Bernstein coefficients: it lies between the smallest and the largest, and
/// has no more roots than they have changes of sign.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bernstein {
    pub(super) degree: usize,
    /// β_0 … β_n, the first and the last being the values at the ends; zeros after them.
    pub(super) beta: [f64; MOST],
}

impl Bernstein {
    /// β_0 … β_n.
    pub(super) fn coefficients(&self) -> &[f64] {
        self.beta.get(..=self.degree).unwrap_or(&self.beta)
    }

    /// The values at both ends.
    pub(super) fn ends(&self) -> [f64; 2] {
        [self.beta[0], self.coefficients().last().copied().unwrap_or(0.0)]
    }

    /// The parts before and after `share`, each on [0, 1] again (de Casteljau).
    pub(super) fn split(&self, share: f64) -> [Self; 2] {
        let (mut left, mut right) = (*self, *self);
        for round in 1..=self.degree {
            for i in 0..=self.degree - round {
                right.beta[i] = (1.0 - share) * right.beta[i] + share * right.beta[i + 1];
            }
            left.beta[round] = right.beta[0];
        }
        [left, right]
    }

    /// The value at `share`.
    pub(super) fn value(&self, share: f64) -> f64 {
        self.value_and_slope(share)[0]
    }

    /// The value and the slope at `share`.
    pub(super) fn value_and_slope(&self, share: f64) -> [f64; 2] {
        let mut beta = self.beta;
        let rest = 1.0 - share;
        for round in 1..self.degree {
            for i in 0..=self.degree - round {
                beta[i] = rest * beta[i] + share * beta[i + 1];
            }
        }
        [rest * beta[0] + share * beta[1], self.degree as f64 * (beta[1] - beta[0])]
    }

    /// The least and the largest coefficient.
    pub(super) fn range(&self) -> [f64; 2] {
        let fold = |[low, high]: [f64; 2], &beta: &f64| [low.min(beta), high.max(beta)];
        self.coefficients().iter().fold([f64::INFINITY, f64::NEG_INFINITY], fold)
    }

    /// The least and the largest slope that its differences admit.
    pub(super) fn slopes(&self) -> [f64; 2] {
        let n = self.degree as f64;
        let differences = self.coefficients().windows(2).map(|pair| n * (pair[1] - pair[0]));
        differences
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], slope| [low.min(slope), high.max(slope)])
    }

    /// The largest distance of a coefficient from the chord, which is 0 for a straight line.
    pub(super) fn bend(&self) -> f64 {
        let [start, end] = self.ends();
        let n = self.degree as f64;
        let chord = |i: usize| start + (end - start) * (i as f64 / n);
        let off = self.coefficients().iter().enumerate().map(|(i, beta)| (beta - chord(i)).abs());
        off.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NODES: [Nodes; 3] =
        [Nodes::new(&Gauss::<2>::NODES), Nodes::new(&Gauss::<5>::NODES), Nodes::new(&Gauss::<8>::NODES)];

    /// τ ↦ (2τ − 0.7)ᵈ.
    fn power(degree: usize, at: f64) -> f64 {
        (2.0 * at - 0.7).powi(degree as i32)
    }

    #[test]
    fn polynomials_go_through_their_values_and_both_parts_are_the_whole() {
        for nodes in &NODES {
            for degree in 0..=nodes.degree {
                let values = nodes.shares.map(|share| power(degree, share));
                let polynomial = nodes.polynomial(&values);
                let [left, right] = polynomial.split(0.3);
                for at in [0.0, 0.1, 0.45, 0.8, 1.0] {
                    let size = 2.0 * nodes.rounding(f64::EPSILON, 4.0_f64.max(power(degree, 1.0)));
                    assert!((polynomial.value(at) - power(degree, at)).abs() < size, "{degree} {at}");
                    assert!((left.value(at) - power(degree, 0.3 * at)).abs() < size);
                    assert!((right.value(at) - power(degree, 0.3 + 0.7 * at)).abs() < size);
                }
                // Positive control: one degree more is missed.
                let values = nodes.shares.map(|share| power(nodes.degree + 1, share));
                let off = nodes.polynomial(&values).value(0.1) - power(nodes.degree + 1, 0.1);
                assert!(off.abs() > 1e-6, "{off}");
            }
        }
    }

    #[test]
    fn tails_are_the_last_legendre_coefficients() {
        for nodes in &NODES {
            let n = nodes.degree;
            for row in 0..3 {
                // P_d(2τ − 1) by its recurrence.
                let legendre = |at: f64| {
                    let (x, mut p) = (2.0 * at - 1.0, (0.0, 1.0));
                    for k in 0..n - row {
                        let k = k as f64;
                        p = (p.1, ((2.0 * k + 1.0) * x * p.1 - k * p.0) / (k + 1.0));
                    }
                    p.1
                };
                let mut values = [0.0; MOST];
                values.iter_mut().zip(&nodes.shares).for_each(|(value, &at)| *value = legendre(at));
                let tails = nodes.tails(&nodes.polynomial(&values));
                for (other, tail) in tails.into_iter().enumerate() {
                    let expected = f64::from(u8::from(other == row));
                    assert!((tail - expected).abs() < 1e-10, "{n} {row} {other}: {tail}");
                }
            }
        }
    }

    #[test]
    fn lebesgue_constants_bound_polynomials_and_are_small() {
        for nodes in &NODES {
            assert!(nodes.lebesgue > 1.0 && nodes.lebesgue < 3.0, "{}", nodes.lebesgue);
            // Alternating values come near to the bound.
            let mut values = [0.0; MOST];
            let mut largest = 0.0_f64;
            for start in 0..=nodes.degree {
                for (i, value) in values.iter_mut().enumerate().take(nodes.degree + 1) {
                    let flips = i.abs_diff(start) + usize::from(i > start);
                    *value = if flips % 2 == 0 { 1.0 } else { -1.0 };
                }
                let polynomial = nodes.polynomial(&values);
                for point in 0..=1000 {
                    largest = largest.max(polynomial.value(f64::from(point) * 1e-3).abs());
                }
            }
            assert!(largest <= nodes.lebesgue && largest > 0.9 * nodes.lebesgue / 1.02, "{largest}");
        }
    }
}
