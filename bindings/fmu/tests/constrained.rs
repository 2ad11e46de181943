//! A unit of a system with a constraint.

mod importer;
#[path = "../examples/constrained.rs"]
mod model;

use dalembert::run::DrivenTrajectory;
use dalembert::{Discretise, Midpoint, State, StepError};
use dalembert_fmu::boundary::Status;
use importer::Imported;
use model::{DrivenSpherical, Spherical, UNIT};

const STATED: Spherical = Spherical { m: 1.3, l: 0.7, c: 0.4 };
const MOTION: [&str; 7] = ["q[0]", "q[1]", "q[2]", "p[0]", "p[1]", "p[2]", "lambda[0]"];

fn imported() -> Imported {
    Imported::new(UNIT.description(), &UNIT.token())
}

fn numbers(State { q, p }: &State<f64, 3>, lambda: f64) -> [f64; 7] {
    [q[0], q[1], q[2], p[0], p[1], p[2], lambda]
}

/// Motion and λ after each of so many steps in Rust, from the nearest state.
fn in_rust(q: [f64; 3], v: [f64; 3], u: f64, steps: usize) -> Result<Vec<[f64; 7]>, StepError> {
    let driven = STATED.driven([u]);
    let start = State::nearest(&STATED.driven([0.0]), q, v)?;
    let mut run = DrivenTrajectory::<DrivenSpherical, Midpoint, 3>::new(0.01, start);
    (0..steps)
        .map(|_| {
            let before = *run.state();
            let step = run.advance(&driven)?;
            let lambda = driven.by(Midpoint, 0.01).reactions::<1>(&before, &step)?;
            Ok(numbers(&step.state, lambda[0]))
        })
        .collect()
}

#[test]
fn a_unit_steps_as_rust_does_and_has_reactions() -> Result<(), StepError> {
    let mut unit = imported();
    unit.set_double("u[0]", 0.3).unwrap();
    unit.start_at(0.0).unwrap();
    let expected = in_rust([0.42, 0.0, -0.56], [0.0, 1.0, 0.0], 0.3, 12)?;
    // Before the first step λ is that of the step that follows, with the input as it is.
    assert_eq!(unit.double(["lambda[0]"]), Ok([expected[0][6]]));
    unit.set_double("u[0]", 3.0).unwrap();
    assert_ne!(unit.double(["lambda[0]"]), Ok([expected[0][6]]));
    unit.set_double("u[0]", 0.3).unwrap();
    unit.step(0.0, 0.01).unwrap();
    assert_eq!(unit.double(MOTION), Ok(expected[0]));
    // Of several steps it is the last one's; bytes have it too.
    unit.step(0.01, 0.1).unwrap();
    assert_eq!(unit.double(MOTION), Ok(expected[10]));
    let bytes = unit.through_bytes().unwrap();
    assert_eq!(unit.double(MOTION), Ok(expected[10]));
    assert_eq!(unit.through_bytes(), Ok(bytes));
    unit.step(0.11, 0.01).unwrap();
    // Without what the run kept. Some roundings of q, of size 0.7, are 1e-13 of the velocity at h = 0.01, and
    // 2m/h times as much of λ.
    let bounds = [1e-15, 1e-15, 1e-15, 2e-13, 2e-13, 2e-13, 4e-11];
    for ((found, expected), bound) in unit.double(MOTION).unwrap().into_iter().zip(expected[11]).zip(bounds) {
        assert!((found - expected).abs() < bound, "{found} {expected}");
    }
    Ok(())
}

#[test]
fn start_values_are_guesses_for_the_nearest_state() -> Result<(), StepError> {
    assert_eq!(UNIT.description().matches(r#"initial="approx""#).count(), 6);
    assert_eq!(UNIT.description_fmi2().unwrap().matches(r#"initial="approx""#).count(), 6);
    let mut unit = imported();
    let (q, v) = ([0.0, 0.3, -0.4], [0.5, 1.0, 1.0]);
    for (i, (q, v)) in q.into_iter().zip(v).enumerate() {
        unit.set_double(&format!("q[{i}]"), q).unwrap();
        unit.set_double(&format!("v[{i}]"), v).unwrap();
    }
    let places = ["q[0]", "q[1]", "q[2]", "v[0]", "v[1]", "v[2]"];
    assert_eq!(unit.double(places), Ok([0.0, 0.3, -0.4, 0.5, 1.0, 1.0]));
    unit.enter_initialization(0.0).unwrap();
    // On the ray from the origin; of the velocity what is across: (1, 1) less its share along (0.6, −0.8).
    for _ in 0..2 {
        let found = unit.double(places).unwrap();
        for (found, expected) in found.into_iter().zip([0.0, 0.42, -0.56, 0.5, 1.12, 0.84]) {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
        let _ = unit.exit_initialization();
    }
    unit.step(0.0, 0.01).unwrap();
    assert_eq!(unit.double(MOTION), Ok(in_rust(q, v, 0.0, 1)?[0]));
    Ok(())
}

#[test]
fn where_no_state_is_in_reach_initialization_fails_and_changes_nothing() {
    let mut unit = imported();
    for name in ["q[0]", "q[1]", "q[2]"] {
        unit.set_double(name, 0.0).unwrap();
    }
    unit.enter_initialization(0.0).unwrap();
    let before = unit.bytes();
    assert_eq!(unit.double(["q[0]"]), Err(Status::Error));
    assert_eq!(unit.exit_initialization(), Err(Status::Error));
    assert_eq!(unit.bytes(), before);
    // What is missing can still be set; hanging at rest the rod carries the weight.
    unit.set_double("q[2]", -0.5).unwrap();
    unit.set_double("v[1]", 0.0).unwrap();
    unit.exit_initialization().unwrap();
    unit.step(0.0, 0.01).unwrap();
    assert!((unit.double(["lambda[0]"]).unwrap()[0] + 1.3 * 9.81).abs() < 1e-12);
    // A longer rod, which no state of this run hangs on: the step fails, and the rod as it was goes on.
    let before = unit.double(MOTION);
    unit.set_double("l", 0.8).unwrap();
    assert_eq!(unit.step(0.01, 0.01), Err(Status::Error));
    unit.set_double("l", 0.7).unwrap();
    assert_eq!(unit.double(MOTION), before);
    unit.step(0.01, 0.01).unwrap();
}

#[test]
fn derivatives_are_those_of_rust() -> Result<(), StepError> {
    let mut unit = imported();
    unit.enter_initialization(0.0).unwrap();
    assert_eq!(unit.along(["energy"], ["q[0]"], [1.0]), Err(Status::Error), "q is a guess");
    unit.exit_initialization().unwrap();
    unit.step(0.0, 0.01).unwrap();
    let driven = STATED.driven([0.0]);
    let start = State::nearest(&driven, [0.42, 0.0, -0.56], [0.0, 1.0, 0.0])?;
    let taken = driven.by(Midpoint, 0.01).linearized(&start)?;
    let (a, b, by_m) = (taken.by_state()?, taken.by_input::<1>()?, taken.by_parameters::<2>()?);
    let expected = [
        ("q[1]", [a.q_by_q[(0, 1)], a.p_by_q[(2, 1)]]),
        ("p[0]", [a.q_by_p[(0, 0)], a.p_by_p[(2, 0)]]),
        ("u[0]", [b.q[0], b.p[2]]),
        ("m", [by_m.q[(0, 0)], by_m.p[(2, 0)]]),
        ("l", [by_m.q[(0, 1)], by_m.p[(2, 1)]]),
    ];
    for (known, expected) in expected {
        assert_eq!(unit.along(["q[0]", "p[2]"], [known], [1.0]), Ok(expected), "{known}");
    }
    assert_eq!(unit.along(["lambda[0]"], ["u[0]"], [1.0]), Err(Status::Error));
    Ok(())
}
