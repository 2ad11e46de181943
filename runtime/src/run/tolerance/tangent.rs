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

/// Terms of the series of the exponential.
const TERMS: u32 = 8;

/// The nodes of Lobatto's rule of four between the ends, and what the inner difference weighs beside the
/// outer one in a mean slope: 5/√5.
pub(super) const INNER: [f64; 2] = [0.276_393_202_250_021, 0.723_606_797_749_979];
const SLOPE: f64 = 2.236_067_977_499_79;

/// The errors after the time `t` between two states: exp(Ω) δ, by W. Magnus's series with J at both ends,
/// and, where they are given, at two states between. With the ends alone Ω = t (J₀ + J₁)/2.
pub(super) fn carried<S: Scalar, const N: usize, const K: usize>(
    errors: [State<S, N>; K],
    from: &Variation<S, N>,
    inner: Option<&[Variation<S, N>; 2]>,
    to: &Variation<S, N>,
    t: S,
) -> [State<S, N>; K] {
    let (a, b) = (&from.matrix, &to.matrix);
    let omega = match inner {
        None => weighted(t * S::constant(0.5), [a, b], S::one()),
        Some([first, second]) => magnus([a, &first.matrix, &second.matrix, b], t),
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
    let tau = S::one() / S::constant(f64::from(parts));
    errors.map(|error| {
        let mut carried = error;
        if carried.q.iter().chain(carried.p.iter()).all(|&x| x == S::zero()) {
            return carried;
        }
        for _ in 0..parts {
            let mut term = carried;
            for k in 1..=TERMS {
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

/// Ω to sixth order (S. Blanes, F. Casas and J. Ros 2000) from J at the nodes of Lobatto's rule, [`INNER`]
/// and the ends.
///
/// ```text
/// J = a₀ + a₁ s + a₂ s²,  s from −½ to ½,  αᵢ = t aᵢ
/// Ω = α₀ + α₂/12 + [−20α₀ − α₂ + C, α₁ + D]/240        C = [α₀, α₁],  D = −[α₀, 2α₂ + C]/60
/// ```
fn magnus<S: Scalar, const N: usize>(nodes: [&PhaseMatrix<S, N>; 4], t: S) -> PhaseMatrix<S, N> {
    let number = S::constant;
    let sum =
        |x: &PhaseMatrix<S, N>, y: &PhaseMatrix<S, N>, share: f64| weighted(S::one(), [x, y], number(share));
    let commutator = |x: &PhaseMatrix<S, N>, y: &PhaseMatrix<S, N>| sum(&(*x * *y), &(*y * *x), -1.0);
    let [a, b, c, d] = nodes;
    let (ends, inner) = (sum(a, d, 1.0), sum(b, c, 1.0));
    // The moments of J: of 1, of s, and of s² less 1/12 of that of 1.
    let mean = weighted(t / number(12.0), [&ends, &inner], number(5.0));
    let slope = weighted(t * number(0.5), [&sum(d, a, -1.0), &sum(c, b, -1.0)], number(SLOPE));
    let bend = weighted(t * number(180.0 / 72.0), [&ends, &inner], -S::one());
    let first = sum(&mean, &bend, -1.0 / 12.0);
    let c = commutator(&first, &slope);
    let d = commutator(&first, &sum(&c, &bend, 2.0));
    let left = sum(&sum(&c, &bend, -1.0), &first, -20.0);
    let right = sum(&slope, &d, -1.0 / 60.0);
    sum(&mean, &commutator(&left, &right), 1.0 / 240.0)
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
