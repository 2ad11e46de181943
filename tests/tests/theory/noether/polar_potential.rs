//! The paper's example with R_d = F(r1, r2, θ1 + θ2), D3F ≠ 0 (section 3.6, example 3): J = r̄²(θ2 − θ1)/h −
//! D3F is a constant of the motion, r̄²(θ2 − θ1)/h alone is not.
//!
//! The midpoint R_d of a friction of the radial motion that depends on the angle, R = ½ κ(θ) ṙ², is of this
//! form.

use dalembert::nalgebra::{SVector, vector};
use dalembert::noether::Generator;
use dalembert::{Discretise, Midpoint, State, rayleigh_system, samples};

/// κ(θ) = k (1 + ½ sin 2θ); m = 1 as in the paper; `swing` is a friction of θ.
#[derive(Clone, Copy)]
struct Polar {
    k: f64,
    swing: f64,
}

#[rayleigh_system]
impl Polar {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + q[0] * q[0] * v[1] * v[1]) - (q[0] * q[0] - 1.0).powi(2)
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.k * (1.0 + 0.5 * (2.0 * q[1]).sin()) * v[0] * v[0] + 0.5 * self.swing * v[1] * v[1]
    }
}

const H: f64 = 0.2;

/// F(r1, r2, s) = (k/4)(r2 − r1)² (1 + ½ sin s), by hand.
fn f(k: f64, r: [f64; 2], s: f64) -> f64 {
    0.25 * k * (r[1] - r[0]).powi(2) * (1.0 + 0.5 * s.sin())
}

/// r̄²(θ2 − θ1)/h and D3F, by hand.
fn parts(k: f64, q0: &SVector<f64, 2>, q1: &SVector<f64, 2>) -> [f64; 2] {
    let mean = 0.5 * (q0[0] + q1[0]);
    let d3 = 0.125 * k * (q1[0] - q0[0]).powi(2) * (q0[1] + q1[1]).cos();
    [mean * mean * (q1[1] - q0[1]) / H, d3]
}

#[test]
fn it_keeps_the_momentum_less_the_slope_of_f() {
    let k = 0.8;
    let system = Polar { k, swing: 0.0 };
    let by = system.by(Midpoint, H);
    let mut state = State::from_velocity(&system, [1.3, 0.4], [0.3, 0.9]).unwrap();
    let (mut kept, mut bare) = (Vec::new(), Vec::new());
    for _ in 0..200 {
        let next = by.step(&state).unwrap().state;
        let r_d = by.discrete_rayleigh(&state.q, &next.q);
        assert!((r_d - f(k, [state.q[0], next.q[0]], state.q[1] + next.q[1])).abs() < 1e-15);
        let [angular, d3] = parts(k, &state.q, &next.q);
        kept.push(angular - d3);
        bare.push(angular);
        // It is the momentum of both transforms.
        assert!((state.p[1] - (angular - d3)).abs() < 1e-13 && (next.p[1] - (angular - d3)).abs() < 1e-13);
        state = next;
    }
    let spread = |of: &[f64]| {
        let (low, high) = of.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
        high - low
    };
    assert!(spread(&kept) < 1e-12, "{}", spread(&kept));
    assert!(spread(&bare) > 1e-4, "{}", spread(&bare));
}

#[test]
fn neither_part_of_the_defect_is_there_but_with_friction_of_the_angle() {
    let theta = Generator::translation("θ", [0.0, 1.0]);
    let segments = samples::segments([0.5, -3.0], [2.0, 3.0], [0.2, 0.4], 100);
    let of = |swing| {
        let system = Polar { k: 0.8, swing };
        system.by(Midpoint, H).noether().symmetry(&theta, &segments).unwrap()
    };
    let kept = of(0.0);
    assert!(kept.is_conserved() && kept.is_symmetry_of_lagrangian() && !kept.force_does_work(), "{kept}");
    // Control: an R_d of θ2 − θ1.
    assert!(!of(0.1).is_conserved());
    // Without the sum no conservation: dF/dθ1 ≠ 0, so that f⁻ and f⁺ each do work and cancel.
    let system = Polar { k: 0.8, swing: 0.0 };
    let force = system.by(Midpoint, H).discrete_force(&vector![1.2, 0.3], &vector![1.4, 0.5]);
    assert!(force.minus[1].abs() > 1e-4 && (force.minus[1] + force.plus[1]).abs() < 1e-16);
}
