//! Which steps on constraints have an R_d.

use dalembert::derivative::PhaseMatrix;
use dalembert::rayleigh::{RayleighStep, RayleighStepError};
use dalembert::step::Flow;
use dalembert::{Composition, Discretise, Midpoint, State, StepError, Trapezoidal, rayleigh_system};

use super::{EVEN, Spherical, UNEVEN};

fn of<M>(system: &Spherical, method: M, h: f64) -> RayleighStep
where
    Spherical: Flow<M, 3, Scalar = f64>,
{
    system.by(method, h).rayleigh_step(&Spherical::states()).unwrap()
}

#[test]
fn rules_give_rayleigh_steps_on_the_sphere_and_methods_of_order_6_do_not() {
    for h in [0.3, 0.05, 1e-3] {
        for found in [of(&UNEVEN, Midpoint, h), of(&UNEVEN, Trapezoidal, h)] {
            assert!(found.is_rayleigh() && found.samples > 2, "{h}: {found}");
        }
    }
    let six = of(&UNEVEN, Composition::kahan_li_6(Midpoint), 0.1);
    assert!(!six.is_rayleigh() && six.at_end.value.abs() > 100.0 * six.at_end.tolerance, "{six}");
}

/// C = 2aM: the trapezoidal step is conformally symplectic on every N, and so are its compositions.
#[test]
fn even_friction_leaves_compositions_of_the_trapezoidal_rule_their_r_d() {
    let system = Spherical { springs: UNEVEN.springs, ..EVEN };
    assert!(of(&system, Composition::kahan_li_6(Trapezoidal), 0.1).is_rayleigh());
    assert!(!of(&system, Composition::kahan_li_6(Midpoint), 0.1).is_rayleigh());
    assert!(!of(&UNEVEN, Composition::kahan_li_6(Trapezoidal), 0.1).is_rayleigh());
}

/// Where the pendulum hangs, x and y are coordinates of N to second order, K = the springs and the gravity:
/// bᵀd − dᵀb = (h⁴/12)[C, K] + … of a method of order 6, a bᵀ − b aᵀ = −(h⁴/12)[C, K] + ….
#[test]
fn the_coefficient_on_the_sphere_is_that_of_its_coordinates() -> Result<(), StepError> {
    let hanging = Spherical::state([0.0, 0.0, -1.0], [0.0; 3]);
    let block = |h: f64| -> Result<RayleighStep, StepError> {
        let (_, a) = UNEVEN.by(Composition::kahan_li_6(Midpoint), h).linearized_step(&hanging)?;
        let on = |x: dalembert::nalgebra::Matrix3<f64>| x.fixed_view::<2, 2>(0, 0).into_owned();
        let [q_by_q, q_by_p, p_by_q, p_by_p] = [a.q_by_q, a.q_by_p, a.p_by_q, a.p_by_p].map(on);
        Ok(RayleighStep::of(&[PhaseMatrix { q_by_q, q_by_p, p_by_q, p_by_p }], None).unwrap())
    };
    // (CK − KC)₁₀ with C = diag(c₀, c₁), K₁₀ = s₁.
    let bracket = (UNEVEN.c[1] - UNEVEN.c[0]) * UNEVEN.springs[1];
    for (end, expected) in [-1.0, 1.0].map(|sign| sign * bracket / 12.0).into_iter().enumerate() {
        let scaled = |h: f64| block(h).map(|of| [of.at_start, of.at_end][end].value / h.powi(4));
        let limit = (8.0 * scaled(0.02)? - 6.0 * scaled(0.04)? + scaled(0.08)?) / 3.0;
        assert!((limit / expected - 1.0).abs() < 1e-3, "{end}: {limit} {expected}");
    }
    Ok(())
}

#[test]
fn what_is_off_the_constraints_has_no_step() {
    let off = State { q: [1.1, 0.0, 0.0].into(), p: [0.0, 1.0, 0.0].into() };
    let error = EVEN.by(Midpoint, 0.05).rayleigh_step(&[Spherical::states()[0], off]).unwrap_err();
    assert!(
        matches!(error, RayleighStepError::Step { sample: 1, error: StepError::OffConstraint { .. } }),
        "{error}"
    );
}

/// Two rods that hinge on one another, in six coordinates with four constraints.
struct Rods;

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Rods {
    fn lagrangian(&self, q: [f64; 6], v: [f64; 6]) -> f64 {
        let of = |i: usize, m: f64| {
            0.5 * m * (v[3 * i].powi(2) + v[3 * i + 1].powi(2) + v[3 * i + 2].powi(2) / 12.0)
                - m * 9.81 * q[3 * i + 1]
        };
        of(0, 1.0) + of(1, 0.7)
    }

    fn rayleigh(&self, v: [f64; 6]) -> f64 {
        0.25 * v[2] * v[2] + 0.015 * (v[5] - v[2]).powi(2)
    }

    fn constraints(&self, q: [f64; 6]) -> [f64; 4] {
        let (a, b) = (q[2], q[5]);
        [
            q[0] - 0.5 * a.sin(),
            q[1] + 0.5 * a.cos(),
            q[3] - q[0] - 0.5 * a.sin() - 0.5 * b.sin(),
            q[4] - q[1] + 0.5 * a.cos() + 0.5 * b.cos(),
        ]
    }
}

#[test]
fn two_rods_in_six_coordinates() -> Result<(), StepError> {
    let q = [0.5, -0.2, 1.0, 1.3, -0.4, 1.8];
    let start = State::nearest(&Rods, q, [0.1, 0.2, 0.3, 0.1, 0.1, -0.2])?;
    for h in [0.1, 0.02, 1e-3] {
        for found in [
            Rods.by(Midpoint, h).rayleigh_step(&[start]).unwrap(),
            Rods.by(Trapezoidal, h).rayleigh_step(&[start]).unwrap(),
        ] {
            assert!(found.is_rayleigh() && found.samples > 1, "{h}: {found}");
        }
    }
    let six = Rods.by(Composition::kahan_li_6(Midpoint), 0.1).rayleigh_step(&[start]).unwrap();
    assert!(!six.is_rayleigh(), "{six}");
    Ok(())
}
