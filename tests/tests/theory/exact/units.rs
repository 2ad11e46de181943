//! Neither the units of the coordinates nor a motion's smallness costs digits.

use dalembert::exact::{Exact, ExistenceVerdict};
use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::rayleigh_system;

/// One system with its coordinates in units 1/s and s.
#[rayleigh_system]
fn scaled(q: [f64; 2], v: [f64; 2], s: f64) -> (f64, f64) {
    let (x, y) = (q[0] / s, q[1] * s);
    let (vx, vy) = (v[0] / s, v[1] * s);
    (
        0.5 * (vx * vx + vy * vy) - x.cosh() - y.cosh() - 0.5 * x * x * y,
        0.15 * (vx * vx + 2.0 * vy * vy) * (1.0 + x * x),
    )
}

#[rayleigh_system]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// f_d+ and D1 f_d+, computed in units s and taken back to s = 1.
fn force_plus(s: f64) -> (SVector<f64, 2>, SMatrix<f64, 2, 2>) {
    let system = Scaled { s };
    let exact = Exact::new(&system);
    let segment = exact.segment(vector![0.2 * s, 0.3 / s], vector![0.5 * s, 0.1 / s], 0.7).unwrap();
    let second = exact.second_derivatives(&segment).unwrap();
    let unit = [s, 1.0 / s];
    (
        SVector::from_fn(|i, _| segment.force.plus[i] * unit[i]),
        SMatrix::from_fn(|i, j| second.force.plus.d1[(i, j)] * unit[i] * unit[j]),
    )
}

#[test]
fn units_of_the_coordinates_do_not_matter() {
    let (force, jacobian) = force_plus(1.0);
    for &s in if cfg!(debug_assertions) { &[1e6][..] } else { &[1e2, 1e4, 1e6] } {
        let (scaled_force, scaled_jacobian) = force_plus(s);
        for i in 0..2 {
            assert!((scaled_force[i] / force[i] - 1.0).abs() < 1e-13, "{s}: {scaled_force} {force}");
            for j in 0..2 {
                let apart = scaled_jacobian[(i, j)] / jacobian[(i, j)] - 1.0;
                assert!(apart.abs() < 1e-11, "{s}: {scaled_jacobian} {jacobian}");
            }
        }
    }
}

#[test]
fn small_motions_and_equilibria_are_resolved() {
    // The pendulum's third derivatives along motions this small are lost in rounding; what they contribute is
    // smaller still.
    let exact = Exact::new(&Pendulum { r: 0.3 });
    for (q0, q1) in [(0.6e-9, 1.1e-9), (0.0, 1e-6), (0.0, 0.0)] {
        let existence = exact.existence(vector![q0], vector![q1], 0.7).unwrap();
        assert_eq!(existence.verdict(), ExistenceVerdict::Holds, "{existence}");
        assert!(existence.tolerance < 1e-13, "{existence}");
    }
    // Positive control: a larger motion violates the condition.
    let existence = exact.existence(vector![0.0], vector![0.1], 0.7).unwrap();
    assert_eq!(existence.verdict(), ExistenceVerdict::MixedFails, "{existence}");
}
