//! For n > 1 an exact discrete force is Rayleigh iff three conditions hold: the one that the paper prints
//! (section 3.4) is D1 f_d⁺ = −(D2 f_d⁻)ᵀ, and the symmetry of D1 f_d⁻ and D2 f_d⁺ must be asked for besides.

use dalembert::exact::{Exact, ExistenceVerdict};
use dalembert::nalgebra::{Matrix2, vector};
use dalembert::rayleigh_system;

/// An isotropic spring in the plane with the circulatory force f = κ(−y, x), which does work on every closed
/// curve.
struct Circulation {
    k: f64,
    kappa: f64,
}

#[rayleigh_system]
impl Circulation {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * self.k * (q[0] * q[0] + q[1] * q[1])
    }

    fn force(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
        [-self.kappa * q[1], self.kappa * q[0]]
    }
}

/// The same spring with a force that has a potential.
struct Attraction {
    k: f64,
}

#[rayleigh_system]
impl Attraction {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * self.k * (q[0] * q[0] + q[1] * q[1])
    }

    fn force(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
        [-0.4 * q[1], -0.4 * q[0]]
    }
}

#[test]
fn the_mixed_condition_does_not_suffice_for_two_degrees_of_freedom() {
    let system = Circulation { k: 1.2, kappa: 0.4 };
    let exact = Exact::new(&system);
    let (q0, q1, h) = (vector![0.3, -0.2], vector![0.5, 0.4], 0.05);
    let existence = exact.existence(q0, q1, h).unwrap();
    // f_q is antisymmetric and f_v is 0: the integrands of the mixed condition cancel.
    assert!(existence.mixed.amax() <= existence.tolerance, "{existence}");
    assert_eq!(existence.verdict(), ExistenceVerdict::SymmetryFails);
    // D2 f+ = κJ h/3 + O(h³), J = [[0, −1], [1, 0]]: f_d+ = ∫ (t/h) f dt along a nearly straight line.
    let expected = Matrix2::new(0.0, -1.0, 1.0, 0.0) * (2.0 * system.kappa * h / 3.0);
    assert!((existence.plus - expected).amax() < h * h * expected.amax(), "{existence}");
    assert!((existence.minus - expected).amax() < h * h * expected.amax(), "{existence}");
    // The terms that cancel in the mixed condition are no smaller than those that do not elsewhere.
    let second = exact.second_derivatives(&exact.segment(q0, q1, h).unwrap()).unwrap();
    assert!(second.force.plus.d1.amax() > 1e9 * existence.mixed.amax());
}

#[test]
fn a_force_with_a_potential_fails_in_the_mixed_condition() {
    // Positive control: the other way round. With f = −dU, D2 f+ is symmetric, and D1 f+ = (D2 f−)ᵀ with the
    // wrong sign.
    let system = Attraction { k: 1.2 };
    let existence = Exact::new(&system).existence(vector![0.3, -0.2], vector![0.5, 0.4], 0.05).unwrap();
    assert_eq!(existence.verdict(), ExistenceVerdict::MixedFails, "{existence}");
    assert!(existence.plus.amax() <= existence.tolerance && existence.minus.amax() <= existence.tolerance);
}
