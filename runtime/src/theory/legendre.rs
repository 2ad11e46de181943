//! Legendre's polynomials, and Gauss's quadrature on their zeros.

use core::f64::consts::PI;
use core::num::NonZeroUsize;

/// P_{n−1} and P_n with their slopes at x, by the recurrence of Legendre's polynomials, n ≥ 1.
pub(super) fn polynomials(n: usize, x: f64) -> [(f64, f64); 2] {
    let (mut p, mut q) = ((1.0, 0.0), (x, 1.0));
    for n in 1..n {
        let n = n as f64;
        let next = ((2.0 * n + 1.0) * x * q.0 - n * p.0) / (n + 1.0);
        let slope = ((2.0 * n + 1.0) * (q.0 + x * q.1) - n * p.1) / (n + 1.0);
        (p, q) = (q, (next, slope));
    }
    [p, q]
}

/// Gauss's quadrature on [0, 1]: exact for polynomials of a degree below twice the number of nodes.
pub(super) struct GaussLegendre {
    /// Nodes, ascending, with their weights, which sum to 1.
    pub(super) nodes: Vec<(f64, f64)>,
}

impl GaussLegendre {
    /// The quadrature of so many nodes, the zeros of P_n: by Newton's method from those of Chebyshev's
    /// polynomial, each to rounding.
    pub(super) fn new(count: NonZeroUsize) -> Self {
        let count = count.get();
        let node = |i: usize| {
            let mut x = -(PI * (i as f64 + 0.75) / (count as f64 + 0.5)).cos();
            for _ in 0..10 {
                let [_, (value, slope)] = polynomials(count, x);
                x -= value / slope;
            }
            let [_, (_, slope)] = polynomials(count, x);
            (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
        };
        Self { nodes: (0..count).map(node).collect() }
    }

    /// ∫ f(x) dx from `a` to `b`.
    pub(super) fn integrate(&self, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        let sum: f64 = self.nodes.iter().map(|(node, weight)| weight * f(a + (b - a) * node)).sum();
        sum * (b - a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn library(count: usize) -> Vec<(f64, f64)> {
        let rule = gauss_quad::GaussLegendre::new(NonZeroUsize::new(count).unwrap());
        let mut nodes: Vec<_> = rule.iter().map(|&(x, w)| (0.5 * (x + 1.0), 0.5 * w)).collect();
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        nodes
    }

    #[test]
    fn nodes_and_weights_are_those_of_a_library() {
        for count in (1..=20).chain([33, 64]) {
            let own = GaussLegendre::new(NonZeroUsize::new(count).unwrap()).nodes;
            assert_eq!(own.len(), count);
            for ((x, w), (node, weight)) in own.into_iter().zip(library(count)) {
                assert!((x - node).abs() < 1e-15 && (w - weight).abs() < 2e-15, "{count}: {x} {w}");
            }
        }
    }

    #[test]
    fn powers_below_twice_the_nodes_are_exact_and_the_next_is_not() {
        for count in 1..=10 {
            let rule = GaussLegendre::new(NonZeroUsize::new(count).unwrap());
            let error = |power: usize| {
                let exact = 1.0 / (power as f64 + 1.0);
                (rule.integrate(0.0, 1.0, |x| x.powi(power as i32)) / exact - 1.0).abs()
            };
            assert!((0..2 * count).all(|power| error(power) < 1e-14));
            assert!(error(2 * count) > 1e-13, "{count}");
        }
    }
}
