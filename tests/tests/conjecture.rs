//! Conjecture of section 3.4: "the exact discrete force of a natural Lagrangian with a Rayleigh force is Rayleigh".
//!
//! It is false. For L = ½mv² − V(q), R = ½rv²,
//!
//! ```text
//! D1 f_d^ex+ + D2 f_d^ex− = −(r/m)(q1−q0) h² ∫₀¹ τ²(1−τ)² V'''(q0 + τ(q1−q0)) dτ + O(h³)
//! ```
//!
//! which is −(r/30m) V'''(q)(q1−q0)h² for some q between; it vanishes for the harmonic oscillator, the paper's example.

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

/// Slope of log |a − b| over log h between h and h/2.
fn halving_slope(a: f64, b: f64) -> f64 {
    (a.abs() / b.abs()).log2()
}

#[test]
fn the_pendulum_violates_it_by_known_amounts() {
    let system = Pendulum { m: 1.0, r: 0.3 };
    // Found with another method, in multiple precision (mathematics, 6.6).
    for (h, expected) in [(0.5, 1.009_485_51e-3), (1.0, 4.967_192_29e-3)] {
        let existence = Exact::rayleigh(&system).existence(vector![0.6], vector![1.1], h).unwrap();
        println!("{existence}");
        assert!(
            (obstruction(&existence) - expected).abs() < 5.1e-12,
            "{h}: {:.12e}",
            obstruction(&existence)
        );
        assert_eq!(existence.verdict(), ExistenceVerdict::MixedFails);
        assert!(existence.tolerance < 1e-11, "{:e}", existence.tolerance);
    }
}
