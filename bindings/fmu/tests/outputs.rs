//! Outputs of the block as variables of a unit: a hoist, whose motion under a constant pull is that of free
//! fall with another acceleration, which the midpoint rule has exactly.

mod importer;

use std::error::Error;

use dalembert::{Midpoint, rayleigh_system};
use dalembert_face::By;
use dalembert_fmu::boundary::Status;
use dalembert_fmu::{NamingError, Unit};
use importer::Imported;

dalembert_fmu::parameters! {
    /// A load on a rope, which a winch pulls.
    ///
    /// - `u[0]` pull: of the winch. Unit: N
    pub struct Hoist {
        /// Mass of the load.
        /// Unit: kg
        pub mass: f64,
        /// Height of the beam.
        /// Unit: m
        pub beam: f64,
    }
}

#[rayleigh_system]
impl Hoist {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.mass * v[0] * v[0] - self.mass * 9.81 * q[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }

    /// What an operator sees.
    ///
    /// - `y[0]` load: distance under the beam. Unit: m
    /// - `y[1]` power: of the winch. Unit: W
    /// - `y[2]`: frequency of the load as a pendulum. Unit: rad/s
    fn outputs(&self, q: [f64; 1], v: [f64; 1], u: [f64; 1], t: f64) -> [f64; 4] {
        let rope = self.beam - q[0];
        [rope, u[0] * v[0], (9.81 / rope).sqrt(), t * v[0]]
    }
}

const STATED: Hoist = Hoist { mass: 2.0, beam: 5.0 };
const OUTPUTS: [&str; 4] = ["load", "power", "y[2]", "y[3]"];

dalembert_fmu::fmu! { hoist: Hoist, rule: Midpoint, step_size: 0.01, parameters: STATED, q: [1.0], v: [0.5] }

/// The outputs at q and v with the pull u at time t.
fn by_hand(q: f64, v: f64, u: f64, t: f64) -> [f64; 4] {
    [5.0 - q, u * v, (9.81 / (5.0 - q)).sqrt(), t * v]
}

fn are_close(found: Result<[f64; 4], Status>, expected: [f64; 4]) -> bool {
    found.unwrap().iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12)
}

fn imported() -> Imported {
    Imported::new(UNIT.description(), &UNIT.token())
}

#[test]
fn outputs_are_those_of_state_input_and_time_at_the_communication_point() {
    let mut unit = imported();
    // Before the start, in initialization and after it.
    assert!(are_close(unit.double(OUTPUTS), by_hand(1.0, 0.5, 0.0, 0.0)));
    unit.enter_initialization(2.0).unwrap();
    unit.set_double("pull", 30.0).unwrap();
    unit.set_double("q[0]", 1.5).unwrap();
    assert!(are_close(unit.double(OUTPUTS), by_hand(1.5, 0.5, 30.0, 2.0)));
    unit.exit_initialization().unwrap();
    assert!(are_close(unit.double(OUTPUTS), by_hand(1.5, 0.5, 30.0, 2.0)));
    for k in 0..10 {
        unit.step(2.0 + 0.1 * f64::from(k), 0.1).unwrap();
        let (t, a) = (0.1 * f64::from(k + 1), 30.0 / 2.0 - 9.81);
        let (q, v) = (1.5 + 0.5 * t + 0.5 * a * t * t, 0.5 + a * t);
        assert!(are_close(unit.double(OUTPUTS), by_hand(q, v, 30.0, 2.0 + t)), "{k}");
        // Another input shows at once, and the controls: each of the four is seen.
        unit.set_double("pull", 20.0).unwrap();
        assert!(are_close(unit.double(OUTPUTS), by_hand(q, v, 20.0, 2.0 + t)));
        unit.set_double("pull", 30.0).unwrap();
        let wrong = [
            (q + 1e-9, v, 30.0, 2.0 + t),
            (q, v + 1e-9, 30.0, 2.0 + t),
            (q, v, 20.0, 2.0 + t),
            (q, v, 30.0, t),
        ];
        for (q, v, u, t) in wrong {
            assert!(!are_close(unit.double(OUTPUTS), by_hand(q, v, u, t)));
        }
    }
    let (outputs, bytes) = (unit.double(OUTPUTS), unit.bytes());
    unit.set_bytes(&bytes).unwrap();
    assert_eq!(unit.double(OUTPUTS), outputs);
    unit.terminate().unwrap();
    assert_eq!(unit.double(OUTPUTS), outputs);
}

#[test]
fn an_output_that_is_no_number_is_an_error_and_the_unit_goes_on() {
    let mut unit = imported();
    unit.start_at(0.0).unwrap();
    unit.set_double("beam", 0.5).unwrap();
    let before = unit.bytes();
    assert_eq!(unit.double(["y[2]"]), Err(Status::Error), "NaN: the load is over the beam");
    assert_eq!(unit.double(["load", "y[2]"]), Err(Status::Error));
    assert_eq!(unit.double(["load", "power"]), Ok([-0.5, 0.0]));
    unit.set_double("beam", 1.0).unwrap();
    assert_eq!(unit.double(["y[2]"]), Err(Status::Error), "infinite: it is at the beam");
    unit.set_double("beam", 0.5).unwrap();
    assert_eq!(unit.bytes(), before);
    unit.step(0.0, 0.1).unwrap();
    unit.set_double("beam", 5.0).unwrap();
    let (q, v) = (1.0 + 0.5 * 0.1 - 0.5 * 9.81 * 0.01, 0.5 - 0.981);
    assert!(are_close(unit.double(OUTPUTS), by_hand(q, v, 0.0, 0.1)), "the control: a number again");
}

#[test]
fn what_is_no_output_of_a_run_is_refused() {
    let mut unit = imported();
    assert_eq!(unit.set_double("load", 1.0), Err(Status::Error));
    unit.start_at(0.0).unwrap();
    unit.step(0.0, 0.1).unwrap();
    assert_eq!(unit.along(["load"], ["q[0]"], [1.0]), Err(Status::Error));
    assert!(unit.along(["energy"], ["q[0]"], [1.0]).is_ok(), "the control");
}

#[test]
fn names_texts_and_units_are_those_of_the_documentation() {
    let [three, two] = [UNIT.description(), UNIT.description_fmi2().unwrap()];
    for part in [
        r#"name="load" valueReference="9" description="distance under the beam." causality="output" variability="continuous" initial="calculated" unit="m"/>"#,
        r#"name="power" valueReference="10" description="of the winch.""#,
        r#"name="y[2]" valueReference="11" description="frequency of the load as a pendulum.""#,
        r#"name="y[3]" valueReference="12" description="Output" causality="output" variability="continuous" initial="calculated"/>"#,
        r#"<Output valueReference="12"/>"#,
        r#"<InitialUnknown valueReference="9"/>"#,
        r#"description="A load on a rope, which a winch pulls.""#,
        r#"name="pull""#,
    ] {
        assert!(three.contains(part), "{part}: {three}");
    }
    for part in [r#"name="load" valueReference="9""#, r#"<Unknown index="13"/>"#, r#"<Real unit="rad/s"/>"#] {
        assert!(two.contains(part), "{part}: {two}");
    }
    assert!(!three.contains(r#"valueReference="13""#), "the control: four and no more");
}

/// Systems whose documentation tells of outputs what cannot be.
mod wrong {
    use super::*;

    macro_rules! unit {
        ($name:ident { $field:ident }, [$($line:literal),+], $outputs:literal) => {
            dalembert_fmu::parameters! {
                /// A load.
                pub struct $name {
                    /// Mass.
                    pub $field: f64,
                }
            }

            #[rayleigh_system]
            impl $name {
                fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                    0.5 * self.$field * v[0] * v[0] - q[0]
                }

                $(#[doc = $line])+
                fn outputs(&self, q: [f64; 1], _v: [f64; 1]) -> [f64; $outputs] {
                    [q[0]; $outputs]
                }
            }

            impl $name {
                pub fn packed() -> Result<String, NamingError> {
                    let unit: Unit<By<Self, Midpoint>, 1> =
                        Unit::new(["load", "Midpoint"], "load", 0.1, Self { $field: 1.0 }, [[0.0], [0.0]]);
                    unit.description_fmi2().map_err(|error| *error.into_inner().unwrap().downcast().unwrap())
                }
            }
        };
    }

    unit!(Right { mass }, ["- `y[0]` load: over the floor", "- `y[1]` again: the same"], 2);
    unit!(Block { mass }, ["\n - `y[0]` load: over the floor\n - `y[1]` again: the same\n"], 2);
    unit!(TooMany { mass }, ["- `y[0]` load: over the floor", "- `y[1]` again: the same"], 1);
    unit!(Twice { mass }, ["- `y[0]` load: over the floor", "- `y[0]` again: the same"], 2);
    unit!(Unnamed { mass }, ["- `y[0]` 2nd: over the floor"], 1);
    unit!(OfField { y }, ["- `y[0]` load: over the floor"], 1);
    unit!(Taken { mass }, ["- `y[0]` mass: of the load"], 1);
}

#[test]
fn names_that_cannot_be_are_typed_errors() -> Result<(), Box<dyn Error>> {
    assert!(wrong::Right::packed()?.contains(r#"name="again""#), "the control");
    assert!(wrong::Block::packed()?.contains(r#"name="again""#), "lines of one text");
    let line = "- `y[1]` again: the same";
    assert_eq!(wrong::TooMany::packed(), Err(NamingError::NoVariable { line }));
    let line = "- `y[0]` again: the same";
    assert_eq!(wrong::Twice::packed(), Err(NamingError::ToldTwice { line }));
    let line = "- `y[0]` 2nd: over the floor";
    assert_eq!(wrong::Unnamed::packed(), Err(NamingError::NoName { line }));
    let line = "- `y[0]` mass: of the load";
    let error = NamingError::NameTwice { line };
    assert_eq!(wrong::Taken::packed(), Err(error));
    let of_field = std::panic::catch_unwind(wrong::OfField::packed);
    let said = *of_field.unwrap_err().downcast::<&str>().unwrap();
    assert!(said.contains("the outputs, y"), "in `fmu!` an error of the compiler: {said}");
    assert!(error.to_string().contains(line) && format!("{error:?}") == error.to_string());
    Ok(())
}
