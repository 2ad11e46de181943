//! How errors are carried from one state to another: exponentials of J.

use nalgebra::SMatrix;

use super::phase::{norm, times};
use super::variation::Variation;
use crate::numbers::Scalar;
use crate::step::{PhaseMatrix, State};

/// Beyond so many substeps, of few coordinates and of many, the exponential is that of the matrix, by
/// squaring.
const SQUARED: [f64; 2] = [8.0, 32.0];

/// Turns beyond which the error is left where it is: its phase is lost.
const LOST: f64 = 1e9;

/// Terms of the series of the exponential at most: to 10⁻³, of an error.
const TERMS: u32 = 6;

/// The share of an error that the first term left out makes.
const LEFT_OUT: f64 = 2e-4;

/// The errors after the time `t` between two states: exp(Ω) δ, by W. Magnus's series with J at both ends,
/// and, where it is given, at the state between. With the ends alone Ω = t (J₀ + J₁)/2.
pub(super) fn carried<S: Scalar, const N: usize, const K: usize>(
    errors: [State<S, N>; K],
    from: &Variation<S, N>,
    middle: Option<&Variation<S, N>>,
    to: &Variation<S, N>,
    t: S,
) -> [State<S, N>; K] {
    let (a, b) = (&from.matrix, &to.matrix);
    let omega = match middle {
        None => weighted(t * S::constant(0.5), [a, b], S::one()),
        Some(middle) => magnus([a, &middle.matrix, b], t),
    };
    let size = norm(&omega).widen();
    if size.is_nan() || size > LOST {
        return errors;
    }
    if size > SQUARED[usize::from(N > 3)] {
        let power = exponential(&omega, size);
        return errors.map(|error| times(&power, &error));
    }
    let parts = nalgebra::ComplexField::ceil(size).max(1.0) as u32;
    let terms = terms(size / f64::from(parts));
    let tau = S::one() / S::constant(f64::from(parts));
    errors.map(|error| {
        let mut carried = error;
        if carried.q.iter().chain(carried.p.iter()).all(|&x| x == S::zero()) {
            return carried;
        }
        for _ in 0..parts {
            let mut term = carried;
            for k in 1..=terms {
                let share = tau / S::constant(f64::from(k));
                let next = times(&omega, &term);
                term = State { q: next.q * share, p: next.p * share };
                carried.q += term.q;
                carried.p += term.p;
            }
        }
        carried
    })
}

/// Terms of the series of exp(Ω) that are worth their cost, where Ω has norm `size`.
fn terms(size: f64) -> u32 {
    let mut term = size;
    (1..TERMS)
        .find(|&k| {
            term *= size / f64::from(k + 1);
            term < LEFT_OUT
        })
        .unwrap_or(TERMS)
}

/// Ω to fourth order (A. Iserles, S. P. Nørsett 1999) from J at the ends and between, by Simpson's rule:
///
/// ```text
/// Ω = t (J₀ + 4 Jₘ + J₁)/6 − t² [J₀, J₁]/12
/// ```
fn magnus<S: Scalar, const N: usize>(nodes: [&PhaseMatrix<S, N>; 3], t: S) -> PhaseMatrix<S, N> {
    let number = S::constant;
    let [a, middle, b] = nodes;
    let ends = weighted(S::one(), [a, b], S::one());
    let mean = weighted(t / number(6.0), [&ends, middle], number(4.0));
    let commutator = weighted(S::one(), [&(*a * *b), &(*b * *a)], -S::one());
    weighted(S::one(), [&mean, &commutator], -t * t / number(12.0))
}

/// exp(Ω) of Ω with norm `size`: the series of Ω/2ᵏ, squared k times.
fn exponential<S: Scalar, const N: usize>(omega: &PhaseMatrix<S, N>, size: f64) -> PhaseMatrix<S, N> {
    let (mut halvings, mut share) = (0, 1.0);
    while size * share > 0.5 {
        halvings += 1;
        share *= 0.5;
    }
    let [zero, unit] = [SMatrix::zeros(), SMatrix::identity()];
    let unit = PhaseMatrix { q_by_q: unit, q_by_p: zero, p_by_q: zero, p_by_p: unit };
    let mut power = unit;
    for k in (1..=TERMS).rev() {
        let factor = S::constant(share / f64::from(k));
        power = weighted(S::one(), [&unit, &(*omega * power)], factor);
    }
    for _ in 0..halvings {
        power = power * power;
    }
    power
}

/// `factor` (a + `share` b).
fn weighted<S: Scalar, const N: usize>(
    factor: S,
    [a, b]: [&PhaseMatrix<S, N>; 2],
    share: S,
) -> PhaseMatrix<S, N> {
    PhaseMatrix {
        q_by_q: (a.q_by_q + b.q_by_q * share) * factor,
        q_by_p: (a.q_by_p + b.q_by_p * share) * factor,
        p_by_q: (a.p_by_q + b.p_by_q * share) * factor,
        p_by_p: (a.p_by_p + b.p_by_p * share) * factor,
    }
}
