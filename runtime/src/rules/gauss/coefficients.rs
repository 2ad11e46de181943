//! The Gauss–Legendre collocation method of s stages, computed when the program is compiled.
//!
//! With the shifted Legendre polynomials P_k(2τ − 1), x = 2c − 1 and quadrature exact to degree 2s − 1, the
//! basis of degree s − 1 is
//!
//! ```text
//! ℓ_j(τ) = b_j Σ_{k<s} (2k + 1) P_k(x_j) P_k(2τ − 1)
//! a_ij = ∫₀^{c_i} ℓ_j dτ = b_j μ_ij,   μ_ij = (x_i + 1)/2 + ½ Σ_{0<k<s} P_k(x_j) (P_{k+1}(x_i) − P_{k−1}(x_i))
//! ```
//!
//! A method is symplectic if b_i a_ij + b_j a_ji = b_i b_j, that is μ_ij + μ_ji = 1. Rounded so that this
//! holds exactly, the coefficients are those of a symplectic method, whatever b is (M. Antoñana, J. Makazaga,
//! A. Murua, *Reducing and monitoring round-off error propagation for symplectic implicit Runge–Kutta
//! schemes*, Numerical Algorithms 76, 2017).

use super::double_double::Double;

/// Nodes, weights and maps of the stages; matrices by columns, so that a column acts on all stages at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coefficients<const S: usize> {
    /// c_i ∈ (0, 1), ascending.
    pub(crate) nodes: [f64; S],
    /// b_i.
    pub(crate) weights: [f64; S],
    /// `shares[j][i]` = μ_ij = a_ij/b_j.
    pub(crate) shares: [[f64; S]; S],
    /// `extrapolation[j][i]` = ℓ_j(1 + c_i): the polynomial through the stages of one step at those of the
    /// next.
    pub(crate) extrapolation: [[f64; S]; S],
    /// `legendre[k][j]` = (2k + 1) b_j P_k(x_j): the coefficients in P_k(2τ − 1) of the polynomial through
    /// the stages.
    pub(crate) legendre: [[f64; S]; S],
}

/// The most stages that there are coefficients for.
const MAX_STAGES: usize = 8;

/// Polynomials kept: P_0 to P_{s+1}.
const POLYNOMIALS: usize = MAX_STAGES + 2;

/// P_0, …, P_{POLYNOMIALS−1} at x, by (k + 1) P_{k+1} = (2k + 1) x P_k − k P_{k−1}.
const fn legendre(x: Double) -> [Double; POLYNOMIALS] {
    let mut values = [Double::new(1.0); POLYNOMIALS];
    values[1] = x;
    let mut k = 1;
    while k + 1 < POLYNOMIALS {
        let next = x.times(values[k]).times(Double::new((2 * k + 1) as f64));
        let next = next.minus(values[k - 1].times(Double::new(k as f64)));
        values[k + 1] = next.over(Double::new((k + 1) as f64));
        k += 1;
    }
    values
}

/// P_s′(x) = s (x P_s − P_{s−1})/(x² − 1).
const fn slope(x: Double, s: usize, p: &[Double; POLYNOMIALS]) -> Double {
    let numerator = x.times(p[s]).minus(p[s - 1]).times(Double::new(s as f64));
    numerator.over(x.times(x).minus(Double::new(1.0)))
}

/// cos θ for θ ∈ [0, π/2], to some digits: the series.
const fn cosine(theta: f64) -> f64 {
    let (mut sum, mut term, mut k) = (1.0, 1.0, 0.0);
    while k < 24.0 {
        term *= -theta * theta / ((k + 1.0) * (k + 2.0));
        sum += term;
        k += 2.0;
    }
    sum
}

/// The roots of P_s, ascending: Newton's method from cos(π(4k − 1)/(4s + 2)).
const fn roots<const S: usize>() -> [Double; S] {
    let mut roots = [Double::new(0.0); S];
    let mut k = 0;
    while k < S / 2 {
        let theta = core::f64::consts::PI * (4 * k + 3) as f64 / (4 * S + 2) as f64;
        let mut x = Double::new(cosine(theta));
        let mut iteration = 0;
        while iteration < 7 {
            let p = legendre(x);
            x = x.minus(p[S].over(slope(x, S, &p)));
            iteration += 1;
        }
        roots[S - 1 - k] = x;
        roots[k] = x.negated();
        k += 1;
    }
    roots
}

impl<const S: usize> Coefficients<S> {
    /// The method of S stages.
    pub(crate) const fn new() -> Self {
        assert!(0 < S && S <= MAX_STAGES, "Gauss<S> is there for 1 to 8 stages");
        let half = Double::new(0.5);
        let roots = roots::<S>();
        let mut all = Self {
            nodes: [0.0; S],
            weights: [0.0; S],
            shares: [[0.0; S]; S],
            extrapolation: [[0.0; S]; S],
            legendre: [[0.0; S]; S],
        };
        let mut j = 0;
        while j < S {
            let x = roots[j];
            let at_j = legendre(x);
            // b = 1/((1 − x²) P_s′(x)²): half of the weight on [−1, 1].
            let slope = slope(x, S, &at_j);
            let weight = Double::new(1.0).over(Double::new(1.0).minus(x.times(x)).times(slope.times(slope)));
            all.nodes[j] = x.plus(Double::new(1.0)).times(half).high;
            all.weights[j] = weight.high;
            let mut k = 0;
            while k < S {
                all.legendre[k][j] = at_j[k].times(weight).times(Double::new((2 * k + 1) as f64)).high;
                k += 1;
            }
            let mut i = 0;
            while i < S {
                let at_i = legendre(roots[i]);
                let beyond = legendre(roots[i].plus(Double::new(2.0)));
                let mut share = roots[i].plus(Double::new(1.0));
                let mut outside = Double::new(1.0);
                let mut k = 1;
                while k < S {
                    share = share.plus(at_j[k].times(at_i[k + 1].minus(at_i[k - 1])));
                    outside = outside.plus(at_j[k].times(beyond[k]).times(Double::new((2 * k + 1) as f64)));
                    k += 1;
                }
                all.shares[j][i] = share.times(half).high;
                all.extrapolation[j][i] = outside.times(weight).high;
                i += 1;
            }
            j += 1;
        }
        all.symplectic()
    }

    /// μ_ij + μ_ji = 1 exactly: the larger of the two rounded, the other what is left, which is a number of
    /// `f64` then.
    const fn symplectic(mut self) -> Self {
        let mut j = 0;
        while j < S {
            self.shares[j][j] = 0.5;
            let mut i = 0;
            while i < j {
                let (a, b) = (self.shares[j][i], self.shares[i][j]);
                if a > b {
                    self.shares[i][j] = 1.0 - a;
                } else {
                    self.shares[j][i] = 1.0 - b;
                }
                i += 1;
            }
            j += 1;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each test for all numbers of stages.
    macro_rules! for_all_stages {
        ($check:ident) => {
            $check::<1>();
            $check::<2>();
            $check::<3>();
            $check::<4>();
            $check::<5>();
            $check::<6>();
            $check::<7>();
            $check::<8>();
        };
    }

    #[test]
    fn two_and_three_stages_are_those_of_the_literature() {
        // Hairer, Lubich and Wanner, Geometric Numerical Integration, table II.1.1.
        let two = Coefficients::<2>::new();
        let root = 3.0_f64.sqrt() / 6.0;
        let a = |c: &Coefficients<2>, i: usize, j: usize| c.weights[j] * c.shares[j][i];
        assert!((two.nodes[0] - (0.5 - root)).abs() < 1e-16 && (two.nodes[1] - (0.5 + root)).abs() < 2e-16);
        assert!(
            (a(&two, 0, 1) - (0.25 - root)).abs() < 1e-16 && (a(&two, 1, 0) - (0.25 + root)).abs() < 1e-16
        );
        let three = Coefficients::<3>::new();
        let root = 15.0_f64.sqrt();
        let printed = [
            [5.0 / 36.0, 2.0 / 9.0 - root / 15.0, 5.0 / 36.0 - root / 30.0],
            [5.0 / 36.0 + root / 24.0, 2.0 / 9.0, 5.0 / 36.0 - root / 24.0],
            [5.0 / 36.0 + root / 30.0, 2.0 / 9.0 + root / 15.0, 5.0 / 36.0],
        ];
        for (i, row) in printed.iter().enumerate() {
            for (j, a) in row.iter().enumerate() {
                assert!((three.weights[j] * three.shares[j][i] - a).abs() < 1e-16, "{i} {j}");
            }
        }
    }

    fn integrates_polynomials<const S: usize>() {
        let c = Coefficients::<S>::new();
        for degree in 0..2 * S as i32 {
            let sum: f64 = (0..S).map(|i| c.weights[i] * c.nodes[i].powi(degree)).sum();
            assert!((sum - 1.0 / f64::from(degree + 1)).abs() < 4e-16, "{S} {degree}");
        }
        // Positive control: not to degree 2s.
        let degree = 2 * S as i32;
        let sum: f64 = (0..S).map(|i| c.weights[i] * c.nodes[i].powi(degree)).sum();
        assert!((sum - 1.0 / f64::from(degree + 1)).abs() > 1e-11, "{S}");
    }

    #[test]
    fn the_quadrature_is_exact_to_degree_2s_minus_1() {
        for_all_stages!(integrates_polynomials);
    }

    fn collocates<const S: usize>() {
        let c = Coefficients::<S>::new();
        for i in 0..S {
            for degree in 0..S as i32 {
                let sum: f64 = (0..S).map(|j| c.weights[j] * c.shares[j][i] * c.nodes[j].powi(degree)).sum();
                let exact = c.nodes[i].powi(degree + 1) / f64::from(degree + 1);
                assert!((sum - exact).abs() < 4e-16, "{S} {i} {degree}");
                let beyond: f64 = (0..S).map(|j| c.extrapolation[j][i] * c.nodes[j].powi(degree)).sum();
                let size: f64 = (0..S).map(|j| c.extrapolation[j][i].abs()).sum();
                let exact = (1.0 + c.nodes[i]).powi(degree);
                assert!(
                    (beyond - exact).abs() < 1e-15 * (size + exact),
                    "{S} {i} {degree}: {beyond} {exact}"
                );
            }
        }
    }

    #[test]
    fn stages_and_extrapolation_are_exact_to_degree_s_minus_1() {
        for_all_stages!(collocates);
    }

    fn is_symplectic<const S: usize>() {
        let c = Coefficients::<S>::new();
        for i in 0..S {
            for j in 0..S {
                assert_eq!(c.shares[j][i] + c.shares[i][j], 1.0);
                // Exact, not by the rounding of this sum.
                assert_eq!(1.0 - c.shares[j][i], c.shares[i][j]);
                assert_eq!(1.0 - c.shares[i][j], c.shares[j][i]);
            }
        }
    }

    #[test]
    fn the_rounded_method_is_symplectic() {
        for_all_stages!(is_symplectic);
    }

    fn agrees_with_a_library<const S: usize>() {
        let c = Coefficients::<S>::new();
        let rule = gauss_quad::GaussLegendre::new(core::num::NonZeroUsize::new(S).unwrap());
        let mut points: Vec<(f64, f64)> = rule.iter().map(|&(x, w)| (0.5 * (x + 1.0), 0.5 * w)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (i, (node, weight)) in points.into_iter().enumerate() {
            assert!((c.nodes[i] - node).abs() < 1e-15 && (c.weights[i] - weight).abs() < 1e-15, "{S} {i}");
        }
    }

    #[test]
    fn nodes_and_weights_are_those_of_gauss_quad() {
        for_all_stages!(agrees_with_a_library);
    }
}
