//! Conjecture of section 3.4: "the exact discrete force of a natural Lagrangian with a Rayleigh force is
//! Rayleigh".
//!
//! It is false. For L = ½mv² − V(q), R = ½rv²,
//!
//! ```text
//! D1 f_d^ex+ + D2 f_d^ex− = −(r/m)(q1−q0) h² ∫₀¹ τ²(1−τ)² V'''(q0 + τ(q1−q0)) dτ + O(h³)
//! ```
//!
//! which is −(r/30m) V'''(q)(q1−q0)h² for some q between; it vanishes for the harmonic oscillator, the
//! paper's example.

use dalembert::exact::{Exact, Existence, ExistenceVerdict};
use dalembert::nalgebra::{Matrix2, vector};
use dalembert::rayleigh_system;

#[rayleigh_system]
fn harmonic(q: [f64; 1], v: [f64; 1], m: f64, r: f64, k: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

#[rayleigh_system]
fn pendulum(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

#[rayleigh_system]
fn quartic(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.25 * q[0].powi(4), 0.5 * r * v[0] * v[0])
}

/// Two coupled springs with damping that is not proportional to mass and stiffness.
#[rayleigh_system]
fn springs(q: [f64; 2], v: [f64; 2], c: f64) -> (f64, f64) {
    let kinetic = 0.5 * (2.0 * v[0] * v[0] + v[1] * v[1]);
    let potential = 0.5 * (3.0 * q[0] * q[0] + q[1] * q[1]) + 0.7 * q[0] * q[1];
    // C = diag(c, 1/5) is proportional to neither M nor K.
    (kinetic - potential, 0.5 * (c * v[0] * v[0] + 0.2 * v[1] * v[1]))
}

/// The same springs with C = c M.
#[rayleigh_system]
fn proportional_springs(q: [f64; 2], v: [f64; 2], c: f64) -> (f64, f64) {
    let kinetic = 0.5 * (2.0 * v[0] * v[0] + v[1] * v[1]);
    let potential = 0.5 * (3.0 * q[0] * q[0] + q[1] * q[1]) + 0.7 * q[0] * q[1];
    (kinetic - potential, c * kinetic)
}

/// Friction c(v0 + v1)²/2, of s = q0 + q1 alone; V = cos(d) + ½ks² + bend s⁴, d = q0 − q1. In (s, d) masses
/// are equal.
#[rayleigh_system]
fn damped_sum(q: [f64; 2], v: [f64; 2], k: f64, c: f64, bend: f64) -> (f64, f64) {
    let (s, d) = (q[0] + q[1], q[0] - q[1]);
    let sum = v[0] + v[1];
    let potential = d.cos() + 0.5 * k * s * s + bend * s.powi(4);
    (0.5 * (v[0] * v[0] + v[1] * v[1]) - potential, 0.5 * c * sum * sum)
}

fn obstruction(existence: &Existence<1>) -> f64 {
    existence.mixed[(0, 0)]
}

/// −(r/m)(q1−q0) h² ∫₀¹ τ²(1−τ)² V'''(q0+τ(q1−q0)) dτ, by Simpson's rule.
fn leading(r: f64, m: f64, third: impl Fn(f64) -> f64, q0: f64, q1: f64, h: f64) -> f64 {
    let cells = 2000;
    let integrand = |tau: f64| (tau * (1.0 - tau)).powi(2) * third(q0 + tau * (q1 - q0));
    let at = |i: usize| integrand(i as f64 / (2 * cells) as f64);
    let sum: f64 = (0..cells).map(|i| at(2 * i) + 4.0 * at(2 * i + 1) + at(2 * i + 2)).sum();
    -(r / m) * (q1 - q0) * h * h * sum / (6.0 * cells as f64)
}

/// Order in h of a quantity from its values at h and h/2.
fn halving_order(at_h: f64, at_half: f64) -> f64 {
    (at_h / at_half).abs().log2()
}

#[test]
fn the_pendulum_violates_it_by_known_amounts() {
    let system = Pendulum { m: 1.0, r: 0.3 };
    // Figures of an independent computation, nine digits (mathematics, 6.6).
    for (h, expected) in [(0.5, 1.009_485_51e-3), (1.0, 4.967_192_29e-3)] {
        let existence = Exact::new(&system).existence(vector![0.6], vector![1.1], h).unwrap();
        let found = obstruction(&existence);
        assert!((found - expected).abs() <= 0.5e-8 * expected, "{h}: {found:.12e}");
        assert_eq!(existence.verdict(), ExistenceVerdict::MixedFails);
        assert!(found > 1e6 * existence.tolerance, "{existence}");
    }
}

#[test]
fn it_holds_for_the_harmonic_oscillator() {
    // The paper's example, and the positive control of the others: the same tool says 0 where the closed form
    // says 0.
    let system = Harmonic { m: 1.3, r: 0.3, k: 2.0 };
    for &h in &[0.1, 2.0, 0.5, 1.0][..if cfg!(debug_assertions) { 2 } else { 4 }] {
        let existence = Exact::new(&system).existence(vector![0.6], vector![1.1], h).unwrap();
        assert_eq!(existence.verdict(), ExistenceVerdict::Holds, "{existence}");
        assert!(obstruction(&existence).abs() < 1e-13, "{existence}");
    }
}

#[test]
fn the_leading_term_is_the_integral_over_the_third_derivative() {
    // Two potentials, masses, damping coefficients, directions; the remainder is of order h³.
    let cases: [(f64, f64, f64, f64); 3] =
        [(1.0, 0.3, 0.6, 1.1), (2.5, 0.8, 0.9, 0.2), (0.7, 0.1, -0.4, 0.5)];
    for (m, r, q0, q1) in cases.into_iter().take(if cfg!(debug_assertions) { 1 } else { 3 }) {
        let pendulum = Pendulum { m, r };
        let quartic = Quartic { m, r };
        let steps = if cfg!(debug_assertions) { &[0.01, 0.005][..] } else { &[0.02, 0.01, 0.005] };
        let of_pendulum = |&h: &f64| {
            let existence = Exact::new(&pendulum).existence(vector![q0], vector![q1], h).unwrap();
            // V = −cos q, V''' = −sin q.
            (obstruction(&existence), leading(r, m, |q| -q.sin(), q0, q1, h))
        };
        let of_quartic = |&h: &f64| {
            let existence = Exact::new(&quartic).existence(vector![q0], vector![q1], h).unwrap();
            // V = q⁴/4, V''' = 6q.
            (obstruction(&existence), leading(r, m, |q| 6.0 * q, q0, q1, h))
        };
        for values in
            [steps.iter().map(of_pendulum).collect(), steps.iter().map(of_quartic).collect::<Vec<_>>()]
        {
            for pair in values.windows(2) {
                let order = halving_order(pair[0].0, pair[1].0);
                assert!((order - 2.0).abs() < 0.02, "order {order} of the obstruction: {values:?}");
                let order = halving_order(pair[0].0 - pair[0].1, pair[1].0 - pair[1].1);
                assert!(order > 2.8, "order {order} of the remainder: {values:?}");
            }
            let (found, predicted) = *values.last().unwrap();
            assert!((found / predicted - 1.0).abs() < 2e-3, "{found:e} {predicted:e}");
        }
    }
}

#[test]
fn the_coefficient_is_one_thirtieth() {
    // V = q⁴/4: V''' = 6q is odd about the middle, so the integral is V'''/30 there, whatever q1 − q0. What
    // is left is c1 h + c2 h² + …, extrapolated away.
    let (m, r, q0, q1) = (1.0, 0.3, 0.6, 1.1);
    let system = Quartic { m, r };
    let coefficient = |h: f64| {
        let existence = Exact::new(&system).existence(vector![q0], vector![q1], h).unwrap();
        obstruction(&existence) * m / (r * 3.0 * (q0 + q1) * (q1 - q0) * h * h)
    };
    let [coarse, middle, fine] = [0.04, 0.02, 0.01].map(coefficient);
    let extrapolated = (coarse - 6.0 * middle + 8.0 * fine) / 3.0;
    println!("{coarse:.9} {middle:.9} {fine:.9} {extrapolated:.9}");
    assert!((extrapolated + 1.0 / 30.0).abs() < 1e-7, "{extrapolated}");
}

#[test]
fn for_two_degrees_of_freedom_a_quadratic_potential_violates_it() {
    // D2f+ − (D2f+)ᵀ = (h²/12)(C M⁻¹K − K M⁻¹C) + O(h³): M = diag(2, 1), K = [[3, .7], [.7, 1]], C = diag(c,
    // 1/5).
    let c = 0.9;
    let system = Springs { c };
    let (mass_inverse, stiffness, damping) =
        (Matrix2::new(0.5, 0.0, 0.0, 1.0), Matrix2::new(3.0, 0.7, 0.7, 1.0), Matrix2::new(c, 0.0, 0.0, 0.2));
    let commutator = damping * mass_inverse * stiffness - stiffness * mass_inverse * damping;
    let steps = if cfg!(debug_assertions) { &[0.1, 0.05][..] } else { &[0.1, 0.05, 0.025] };
    let remainder = |&h: &f64| {
        let existence = Exact::new(&system).existence(vector![0.3, -0.2], vector![0.5, 0.4], h).unwrap();
        assert_ne!(existence.verdict(), ExistenceVerdict::Holds, "{existence}");
        let predicted = commutator * (h * h / 12.0);
        assert!((existence.plus - predicted).amax() < 0.2 * predicted.amax(), "{existence}");
        (existence.plus - predicted).amax()
    };
    let remainders: Vec<_> = steps.iter().map(remainder).collect();
    for pair in remainders.windows(2) {
        assert!(halving_order(pair[0], pair[1]) > 2.9, "{remainders:?}");
    }
}

/// V = ½q₀²q₁², M = diag(2, 1), C = diag(c, 1/5).
#[rayleigh_system]
fn product(q: [f64; 2], v: [f64; 2], c: f64) -> (f64, f64) {
    let kinetic = 0.5 * (2.0 * v[0] * v[0] + v[1] * v[1]);
    let x = q[0] * q[1];
    (kinetic - 0.5 * x * x, 0.5 * (c * v[0] * v[0] + 0.2 * v[1] * v[1]))
}

/// V nonlinear, q0 and q1 fixed: h² ∫₀¹ τ²(1−τ)(CM⁻¹V″ − V″M⁻¹C)(q0 + τ(q1−q0)) dτ. With V″ at one place,
/// h²/12 times the bracket, the remainder stays of order 2.
#[test]
fn for_a_nonlinear_potential_the_asymmetry_is_an_integral_along_the_segment() {
    let (c, q0, q1) = (0.9, vector![0.3, -0.2], vector![0.5, 0.6]);
    let bracket = |tau: f64| {
        let q = q0 + (q1 - q0) * tau;
        // Only ∂²V/∂q₀∂q₁ = 2q₀q₁ does not cancel.
        (c / 2.0 - 0.2) * 2.0 * q[0] * q[1]
    };
    // A polynomial of degree 5: three nodes of Gauss.
    let integral: f64 = [(-0.6_f64.sqrt(), 5.0), (0.0, 8.0), (0.6_f64.sqrt(), 5.0)]
        .map(|(x, weight)| (0.5 * (1.0 + x), weight / 18.0))
        .iter()
        .map(|(tau, weight)| weight * tau * tau * (1.0 - tau) * bracket(*tau))
        .sum();
    let asymmetry = |h: f64| {
        let existence = Exact::new(&Product { c }).existence(q0, q1, h).unwrap();
        assert_ne!(existence.verdict(), ExistenceVerdict::Holds, "{existence}");
        existence.plus[(0, 1)]
    };
    let [wide, narrow] = [0.1, 0.05].map(|h| (h * h, asymmetry(h)));
    let order =
        |coefficient: f64| halving_order(wide.1 - coefficient * wide.0, narrow.1 - coefficient * narrow.0);
    assert!(order(integral) > 2.8, "{} {integral}: {wide:?} {narrow:?}", order(integral));
    for tau in [0.0, 0.5, 1.0] {
        let order = order(bracket(tau) / 12.0);
        assert!(order < 2.2, "{tau}: {order}");
    }
}

#[test]
fn proportional_damping_keeps_it_for_a_quadratic_potential() {
    // Positive control of the last test: C = c M commutes, the normal modes are damped oscillators each.
    let existence = Exact::new(&ProportionalSprings { c: 0.4 })
        .existence(vector![0.3, -0.2], vector![0.5, 0.4], 0.5)
        .unwrap();
    assert_eq!(existence.verdict(), ExistenceVerdict::Holds, "{existence}");
    assert!(existence.largest() < 1e-12, "{existence}");
}

/// CM⁻¹V″ symmetric and V'''(M⁻¹Cu, ·, ·) = 0: where no friction acts V is as it will.
#[test]
fn it_holds_where_friction_acts_on_a_linear_part_with_classical_modes() {
    let ends = (vector![0.3, -0.2], vector![0.5, 0.4]);
    let of = |bend: f64, h: f64| {
        let system = DampedSum { k: 1.7, c: 0.6, bend };
        Exact::new(&system).existence(ends.0, ends.1, h).unwrap()
    };
    let held = of(0.0, 0.5);
    assert_eq!(held.verdict(), ExistenceVerdict::Holds, "{held}");
    assert!(held.largest() < 1e-12, "{held}");
    // Control: CM⁻¹V″ stays symmetric, V''' does not vanish along the friction: the mixed condition alone
    // fails.
    let (c, bend) = (0.6, 0.3);
    let bent = [0.1, 0.05].map(|h| of(bend, h));
    // −h² ∫₀¹ τ²(1−τ)² V'''(M⁻¹C(q1 − q0), ·, ·) dτ, V''' = 24 bend s in every entry; the weight, 1/30 in
    // all, is even about the middle, so that s counts by its mean.
    let predicted = |h: f64| {
        let (mean, change) = (0.5 * (ends.0.sum() + ends.1.sum()), ends.1.sum() - ends.0.sum());
        -h * h / 30.0 * 24.0 * bend * mean * 2.0 * c * change
    };
    let miss = |i: usize, h: f64| bent[i].mixed.add_scalar(-predicted(h)).amax();
    let misses = [miss(0, 0.1), miss(1, 0.05)];
    assert!(halving_order(misses[0], misses[1]) > 2.8, "{misses:?} {}", predicted(0.05));
    let [bent, _] = bent;
    assert!(bent.mixed.amax() > 1e-4 && bent.plus.amax() < 1e-12 && bent.minus.amax() < 1e-12, "{bent}");
}
