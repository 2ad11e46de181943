//! What steps with friction refuse.

use dalembert::nalgebra::vector;
use dalembert::{Discretise, Proximal, State, StepError, rayleigh_system};

struct Pushed {
    mu: f64,
}

#[rayleigh_system(rule = proximal)]
impl Pushed {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) + 0.1 * q[0] - 0.0 * q[1]
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.1 * v[1].abs() + self.mu * v[0].abs()
    }
}

#[test]
fn a_negative_factor_is_named() {
    let still = State { q: vector![0.0, 0.0], p: vector![0.0, 0.0] };
    let error = Pushed { mu: -0.2 }.by(Proximal, 0.1).step(&still).unwrap_err();
    assert_eq!(error, StepError::NegativeFriction { component: 1, limit: -0.2 });
    assert!(Pushed { mu: 0.0 }.by(Proximal, 0.1).step(&still).is_ok());
}

#[test]
fn a_force_at_its_limit_has_no_derivative() {
    let still = State { q: vector![0.0, 0.0], p: vector![0.0, 0.0] };
    let by_state = |mu: f64| Pushed { mu }.by(Proximal, 0.1).linearized(&still).map(|step| step.by_state());
    assert_eq!(by_state(0.1).unwrap_err(), StepError::AtLimitOfFriction { component: 1 });
    assert!(by_state(0.2).is_ok() && by_state(0.05).is_ok());
}

#[test]
fn friction_has_no_step_back_in_time() {
    let still = State { q: vector![0.0, 0.0], p: vector![0.3, 0.0] };
    let by = Pushed { mu: 0.2 }.by(Proximal, -0.1);
    let error = by.step(&still).unwrap_err();
    assert!(matches!(error, StepError::NotConvex { h: -0.1, enough: 0.05, .. }), "{error}");
    assert!(by.with_step(0.05).step(&still).is_ok());
}

#[test]
fn a_factor_that_is_no_number_is_an_error() {
    let still = State { q: vector![0.0, 0.0], p: vector![0.0, 0.0] };
    assert!(Pushed { mu: f64::NAN }.by(Proximal, 0.1).step(&still).is_err());
    assert!(Pushed { mu: f64::INFINITY }.by(Proximal, 0.1).step(&still).is_err());
}
