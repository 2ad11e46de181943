//! A Lagrangian whose momenta do not determine velocities is refused at the first step, by its coordinate.

use dalembert::nalgebra::vector;
use dalembert::{Discretise, Midpoint, State, StepError, Trapezoidal, rayleigh_system};

/// The third coordinate has no kinetic energy, and no friction of its own.
#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn massless(q: [f64; 3], v: [f64; 3], m: f64, k: f64) -> (f64, f64) {
    let square: f64 = q.iter().map(|x| x * x).sum();
    (0.5 * m * (v[0] * v[0] + v[1] * v[1]) - 0.5 * k * square, 0.1 * v[1] * v[1] + 0.0 * v[2])
}

/// Kinetic energy in v_x + c v_y only: ∂²L/∂v² = [[1, c], [c, c²]] has rank 1 but no zero entry.
#[rayleigh_system]
fn rank_one(q: [f64; 2], v: [f64; 2], c: f64) -> f64 {
    let u = v[0] + c * v[1];
    0.5 * u * u - 0.5 * (q[0] * q[0] + q[1] * q[1])
}

/// Masses that differ by 48 decades and a strong coupling: regular, though it does not look it.
#[rayleigh_system]
fn badly_scaled(q: [f64; 2], v: [f64; 2], coupling: f64) -> f64 {
    0.5e-24 * v[0] * v[0] + 0.5e24 * v[1] * v[1] + coupling * v[0] * v[1] - 0.0 * q[0]
}

#[test]
fn a_coordinate_without_kinetic_energy() {
    let system = Massless { m: 1.3, k: 0.7 };
    let degenerate = StepError::DegenerateLagrangian { column: 2 };
    let state = State { q: vector![0.1, 0.2, 0.3], p: vector![0.4, 0.5, 0.0] };
    assert_eq!(State::from_velocity(&system, state.q, vector![0.4, 0.5, 0.6]), Err(degenerate));
    assert_eq!(state.velocity(&system), Err(degenerate));
    assert_eq!(state.energy(&system), Err(degenerate));
    assert_eq!(system.by(Midpoint, 0.1).step(&state).unwrap_err(), degenerate);
    assert_eq!(system.by(Trapezoidal, 0.1).step(&state).unwrap_err(), degenerate);
    let mut trajectory = system.by(Midpoint, 0.1).run(state);
    assert_eq!(trajectory.next().unwrap().unwrap_err(), degenerate);
    let text = degenerate.to_string();
    assert!(text.contains("∂²L/∂v² is singular") && text.contains("coordinate 2"), "{text}");
}

#[test]
fn a_mass_matrix_of_deficient_rank() {
    for c in [1.0, 0.1, -3.0, 1e-9, 1e9] {
        let state = State { q: vector![0.1, 0.2], p: vector![0.4, 0.4 * c] };
        let error = RankOne { c }.by(Midpoint, 0.1).step(&state).unwrap_err();
        assert!(matches!(error, StepError::DegenerateLagrangian { .. }), "{c}: {error}");
    }
}

/// Positive control: small masses and small determinants are not degenerate.
#[test]
fn bad_scaling_is_not_degenerate() {
    for coupling in [0.0, 0.5, -0.99] {
        let system = BadlyScaled { coupling };
        // M = D [[1, c], [c, 1]] D with D = diag(1e-12, 1e12).
        let v = vector![1e12, -2e-12];
        let state = State::from_velocity(&system, vector![0.0, 0.0], v).unwrap();
        let step = system.by(Midpoint, 0.1).step(&state).unwrap();
        // Free motion: v̄ = v, to rounding times the condition number of the scaled matrix, (1 + |c|)/(1 −
        // |c|) < 200.
        for i in 0..2 {
            assert!((step.velocity[i] / v[i] - 1.0).abs() < 1e-13, "{coupling}: {}", step.velocity);
        }
    }
}

/// An almost degenerate mass matrix that still carries digits is solved.
#[test]
fn an_almost_degenerate_mass_matrix_is_solved() {
    let system = BadlyScaled { coupling: 1.0 - 1e-8 };
    let v = vector![1e12, 3e-12];
    let state = State::from_velocity(&system, vector![0.0, 0.0], v).unwrap();
    let velocity = state.velocity(&system).unwrap();
    for i in 0..2 {
        assert!((velocity[i] / v[i] - 1.0).abs() < 1e-7, "{velocity}");
    }
}
