//! The matrix (a_ij) of a Gauss method taken apart: its eigenvalues, and the vectors that go with them.
//!
//! On polynomials of degree below s it is integration from 0, so that in the shifted Legendre polynomials
//!
//! ```text
//! ∫₀^τ P_0 = (P_1 + P_0)/2,   ∫₀^τ P_m = (P_{m+1} − P_{m−1})/(2 (2m + 1))
//! ```
//!
//! it has three diagonals, and its vectors follow from an eigenvalue by recurrence (E. Hairer, G. Wanner,
//! *Solving Ordinary Differential Equations II*, section IV.5). Values at the stages are those of the
//! polynomials at the nodes; back, the coefficient of P_m is (2m + 1) Σ b_i P_m(2c_i − 1) u_i.

use super::coefficients::Coefficients;

/// A complex number: real and imaginary part.
pub(super) type Complex = [f64; 2];

/// Eigenvalues with imaginary part ≥ 0, one of each pair, for 1 to 8 stages, from 40 digits.
#[expect(clippy::excessive_precision, reason = "digits of the numbers, not of their roundings")]
const EIGENVALUES: [[Complex; 4]; 8] = [
    [[0.5, 0.0], NONE, NONE, NONE],
    [[0.25, 0.14433756729740644113], NONE, NONE, NONE],
    [[0.21531442311611217824, 0.0], [0.14234278844194391088, 0.13579992570815380307], NONE, NONE],
    [
        [0.15843375973428236397, 0.047441012571108437007],
        [0.091566240265717636034, 0.11566261301312760659],
        NONE,
        NONE,
    ],
    [
        [0.1371088129651922594, 0.0],
        [0.11742725435969863183, 0.06104970381853819685],
        [0.064018339157705238468, 0.098341069173109194538],
        NONE,
    ],
    [
        [0.11298148735321377043, 0.023070678358901354658],
        [0.089573203698748515728, 0.062971624731703068012],
        [0.047445308948037713838, 0.084722574097167072872],
        NONE,
    ],
    [
        [0.10056746482250483621, 0.0],
        [0.0926947727663232158, 0.033882488943913687213],
        [0.070328696979243324867, 0.060773909166175561184],
        [0.036692797843181041229, 0.074059703707308631613],
    ],
    [
        [0.087372903654552226579, 0.013566130868846304945],
        [0.076688973859411998999, 0.038547151769477275084],
        [0.056629165024864068607, 0.057227482069531062746],
        [0.029308957461171705815, 0.06559618487282389957],
    ],
];

const NONE: Complex = [0.0; 2];

/// One eigenvalue λ, or the pair of λ and its conjugate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode<const S: usize> {
    pub(super) eigenvalue: Complex,
    /// Its share of values at the stages: z = Σ_i `left`_i u_i.
    pub(super) left: [Complex; S],
    /// Back: u_i = Σ over all modes of Re(`right`_i z).
    pub(super) right: [Complex; S],
}

/// How many modes there are of S stages: pairs count once.
pub(super) const fn number_of_modes(stages: usize) -> usize {
    stages.div_ceil(2)
}

/// The modes of S stages; the first [`number_of_modes`].
pub(super) const fn modes<const S: usize>(coefficients: &Coefficients<S>) -> [Mode<S>; S] {
    let mut modes = [Mode { eigenvalue: NONE, left: [NONE; S], right: [NONE; S] }; S];
    let mut k = 0;
    while k < number_of_modes(S) {
        modes[k] = mode(EIGENVALUES[S - 1][k], coefficients);
        k += 1;
    }
    modes
}

const fn mode<const S: usize>(eigenvalue: Complex, coefficients: &Coefficients<S>) -> Mode<S> {
    // Right and left vector in Legendre polynomials, and their product.
    let (mut x, mut y) = ([NONE; S], [NONE; S]);
    (x[0], y[0]) = ([1.0, 0.0], [1.0, 0.0]);
    let shifted = [0.5 - eigenvalue[0], -eigenvalue[1]];
    let mut product = [1.0, 0.0];
    let mut m = 0;
    while m + 1 < S {
        let of_degree = m as f64;
        let diagonal = if m == 0 { shifted } else { [-eigenvalue[0], -eigenvalue[1]] };
        let (mut right, mut left) = (times(diagonal, x[m]), scaled(times(diagonal, y[m]), -2.0));
        left = scaled(left, 2.0 * of_degree + 1.0);
        if m > 0 {
            right = sum(right, scaled(x[m - 1], 0.5 / (2.0 * of_degree - 1.0)));
            left = sum(left, y[m - 1]);
        }
        m += 1;
        (x[m], y[m]) = (scaled(right, 4.0 * of_degree + 6.0), left);
        product = sum(product, times(x[m], y[m]));
    }
    let per_product = {
        let [re, im] = product;
        let square = re * re + im * im;
        [re / square, -im / square]
    };
    // A pair counts twice.
    let count = if eigenvalue[1] > 0.0 { 2.0 } else { 1.0 };
    let mut mode = Mode { eigenvalue, left: [NONE; S], right: [NONE; S] };
    let mut i = 0;
    while i < S {
        let mut m = 0;
        while m < S {
            // (2m + 1) b_i P_m at the node.
            let p = coefficients.legendre[m][i];
            mode.left[i] = sum(mode.left[i], scaled(y[m], p));
            mode.right[i] = sum(mode.right[i], scaled(x[m], p / (2 * m + 1) as f64));
            m += 1;
        }
        mode.left[i] = times(mode.left[i], per_product);
        mode.right[i] = scaled(mode.right[i], count / coefficients.weights[i]);
        i += 1;
    }
    mode
}

const fn sum([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a + c, b + d]
}

const fn times([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

const fn scaled([a, b]: Complex, factor: f64) -> Complex {
    [a * factor, b * factor]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σ_j a_ij u_j by the modes and by the coefficients; u back from its modes. The modes of 8 stages are
    /// nearly parallel: rounding grows by about 10⁷ in taking numbers apart and putting them together.
    fn takes_the_matrix_apart<const S: usize>() {
        let c = Coefficients::<S>::new();
        let modes = modes(&c);
        for j in 0..S {
            for i in 0..S {
                let (mut a, mut one) = (0.0, 0.0);
                for mode in &modes[..number_of_modes(S)] {
                    a += times(mode.right[i], times(mode.eigenvalue, mode.left[j]))[0];
                    one += times(mode.right[i], mode.left[j])[0];
                }
                let exact = c.weights[j] * c.shares[j][i];
                assert!((a - exact).abs() < 1e-9, "{S} {i} {j}: {a} {exact}");
                assert!((one - f64::from(u8::from(i == j))).abs() < 1e-8, "{S} {i} {j}: {one}");
            }
        }
    }

    #[test]
    fn modes_give_the_matrix_back() {
        takes_the_matrix_apart::<1>();
        takes_the_matrix_apart::<2>();
        takes_the_matrix_apart::<3>();
        takes_the_matrix_apart::<4>();
        takes_the_matrix_apart::<5>();
        takes_the_matrix_apart::<6>();
        takes_the_matrix_apart::<7>();
        takes_the_matrix_apart::<8>();
    }

    #[test]
    fn another_eigenvalue_does_not() {
        let c = Coefficients::<2>::new();
        let [re, im] = EIGENVALUES[1][0];
        let mode = mode([re * (1.0 + 1e-6), im], &c);
        let a = times(mode.right[0], times(mode.eigenvalue, mode.left[0]))[0];
        assert!((a - c.weights[0] * c.shares[0][0]).abs() > 1e-8, "{a}");
    }
}
