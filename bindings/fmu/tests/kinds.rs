//! A unit of a system with two inputs and the time, fields of all shapes, and a body that can panic.

mod importer;

use dalembert::run::DrivenTrajectory;
use dalembert::{Gauss, State, rayleigh_system};
use dalembert_fmu::boundary::Status;
use importer::Imported;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

dalembert_fmu::parameters! {
    /// A pendulum whose gravity swells & ebbs, with two inputs.
    ///
    /// - `q[0]`: Unit: rad
    /// - `v[0]` swing.rate: of the angle
    pub struct Winch {
        /// Which of the weights pulls.
        pub choice: u8,
        /// Drag.
        /// Unit: N.m.s
        pub c: f64,
        /// Weights of it, < 2.
        pub weights: [[f64; 2]; 2],
        /// Twice the offset.
        pub turns: [i16; 3],
    }
}

#[rayleigh_system(rule = gauss, parameters = [c])]
impl Winch {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        let pull = self.weights[1][self.choice as usize] + 0.1 * (3.0 * t).sin();
        0.5 * v[0] * v[0] + pull * (q[0] - 0.5 * self.turns[2] as f64).cos()
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.c * v[0] * v[0]
    }

    fn force(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 2], t: f64) -> [f64; 1] {
        [u[0] * q[0].cos() + u[1] * t.cos()]
    }
}

const STATED: Winch = Winch { choice: 1, c: 0.2, weights: [[0.0, 3.0], [7.0, 1.5]], turns: [5, 6, -1] };

dalembert_fmu::fmu! {
    winch: Winch, rule: Gauss<2>, step_size: 0.02, parameters: STATED, q: [0.4], v: [-0.1]
}

fn imported() -> Imported {
    Imported::new(UNIT.description(), &UNIT.token())
}

/// The run in Rust from time 2.5: q, p and, of the last step, ∂(q1, p1)/∂u and ∂/∂c.
fn in_rust(system: &Winch, steps: u32, u: [f64; 2]) -> ([f64; 2], [[f64; 3]; 2]) {
    let at = |time: f64| system.driven(u, time);
    let start = State::from_velocity(&at(2.5), [0.4], [-0.1]).unwrap();
    let mut run = DrivenTrajectory::<DrivenWinch, Gauss<2>, 1>::new(0.02, start);
    let mut derivatives = [[0.0; 3]; 2];
    for _ in 0..steps {
        let view = at(2.5 + run.time());
        let taken = run.advance_linearized(&view).unwrap();
        let (b, c) = (taken.by_input::<2>().unwrap(), taken.by_parameters::<1>().unwrap());
        derivatives = [[b.q[0], b.q[1], c.q[0]], [b.p[0], b.p[1], c.p[0]]];
    }
    ([run.state().q[0], run.state().p[0]], derivatives)
}

#[test]
fn a_unit_steps_as_rust_does_with_inputs_and_time() {
    let mut unit = imported();
    unit.set_double("u[0]", 0.3).unwrap();
    unit.set_double("u[1]", -0.2).unwrap();
    unit.start_at(2.5).unwrap();
    for k in 0..10 {
        let end = unit.step(2.5 + 0.02 * f64::from(k), 0.02).unwrap();
        assert_eq!(end, 2.5 + 0.02 * f64::from(k + 1));
    }
    let (state, derivatives) = in_rust(&STATED, 10, [0.3, -0.2]);
    assert_eq!(unit.double(["q[0]", "p[0]"]), Ok(state));
    for (name, known) in ["u[0]", "u[1]", "c"].into_iter().zip(0..) {
        let found = unit.along(["q[0]", "p[0]"], [name], [1.0]).unwrap();
        assert_eq!(found, derivatives.map(|row| row[known]), "{name}");
    }
    let from_elsewhere = in_rust(&STATED, 10, [0.3, 0.2]).0;
    assert_ne!(unit.double(["q[0]", "p[0]"]), Ok(from_elsewhere), "the control: an input counts");
}

#[test]
fn fields_of_all_shapes_are_parameters() {
    let description = UNIT.description();
    for part in [
        r#"<UInt8 name="choice""#,
        r#"<Int16 name="turns[2]""#,
        r#"name="weights[1,0]""#,
        r#"description="Drag." causality="parameter" variability="tunable" initial="exact" unit="N.m.s" start="0.2""#,
        r#"description="A pendulum whose gravity swells &amp; ebbs, with two inputs.""#,
        r#"name="q[0]" valueReference="13" description="Configuration""#,
        r#"<Float64 name="swing.rate" valueReference="14" description="of the angle""#,
        r#"unit="rad/s""#,
        "Weights of it, &lt; 2.",
    ] {
        assert!(description.contains(part), "{part}: {description}");
    }

    let mut unit = imported();
    unit.set_byte("choice", 0).unwrap();
    unit.set_double("weights[1,0]", 2.25).unwrap();
    unit.set_short("turns[2]", -3).unwrap();
    assert_eq!((unit.byte(["choice"]), unit.short(["turns[0]", "turns[2]"])), (Ok([0]), Ok([5, -3])));
    assert_eq!(unit.set_short("choice", 1), Err(Status::Error), "of another type");
    unit.start_at(2.5).unwrap();
    unit.step(2.5, 0.1).unwrap();
    let other = Winch { choice: 0, weights: [[0.0, 3.0], [2.25, 1.5]], turns: [5, 6, -3], ..STATED };
    assert_eq!(unit.double(["q[0]", "p[0]"]), Ok(in_rust(&other, 5, [0.0; 2]).0));
    assert_ne!(unit.double(["q[0]", "p[0]"]), Ok(in_rust(&STATED, 5, [0.0; 2]).0), "the control");

    // By FMI 2.0 the integers are of one type.
    assert!(UNIT.description_fmi2().unwrap().contains(r#"<Integer start="-1"/>"#));
    assert_eq!(unit.integer("turns[2]"), Ok(-3));
    assert_eq!(unit.set_integer("choice", 256), Err(Status::Error), "no u8");
    assert_eq!((unit.set_integer("turns[0]", -300), unit.short(["turns[0]"])), (Ok(()), Ok([-300])));
    unit.set_integer("turns[0]", 5).unwrap();

    // All of it is in the state.
    let bytes = unit.through_bytes().unwrap();
    assert_eq!((unit.byte(["choice"]), unit.short(["turns[0]", "turns[2]"])), (Ok([0]), Ok([5, -3])));
    assert_eq!(unit.double(["weights[1,0]", "weights[1,1]"]), Ok([2.25, 1.5]));
    assert_eq!(unit.through_bytes(), Ok(bytes));
}

#[test]
fn a_panic_ends_the_instance_and_nothing_else() {
    let (mut unit, mut other) = (imported(), imported());
    for unit in [&mut unit, &mut other] {
        unit.start_at(2.5).unwrap();
        unit.step(2.5, 0.02).unwrap();
    }
    unit.set_byte("choice", 2).unwrap();
    assert_eq!(unit.step(2.52, 0.02), Err(Status::Fatal));
    assert_eq!(unit.set_byte("choice", 1), Err(Status::Fatal));
    assert_eq!(unit.double(["q[0]"]), Err(Status::Fatal));
    other.step(2.52, 0.02).unwrap();
    assert_eq!(other.double(["q[0]", "p[0]"]), Ok(in_rust(&STATED, 2, [0.0; 2]).0));
}

/// Numbers, some of which no variable takes.
const NUMBERS: [f64; 9] = [0.3, -0.2, 1.0, 0.0, 1e300, 0.02, f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// What an importer may do, and what it may not.
fn call(unit: &mut Imported, random: &mut StdRng) -> Result<(), Status> {
    let number = NUMBERS[random.random_range(0..NUMBERS.len())];
    let doubles = [
        "time",
        "step_size",
        "c",
        "weights[1,1]",
        "u[0]",
        "u[1]",
        "q[0]",
        "swing.rate",
        "p[0]",
        "energy",
        "choice",
    ];
    let double = doubles[random.random_range(0..doubles.len())];
    match random.random_range(0..14) {
        0 => unit.enter_initialization(number),
        1 => unit.exit_initialization(),
        2..=4 => {
            let now = unit.double(["time"])?[0];
            let size = if random.random_bool(0.7) { 0.04 } else { number };
            unit.step(if random.random_bool(0.9) { now } else { number }, size).map(drop)
        }
        5..=7 => unit.set_double(double, number),
        8 => unit.set_short("turns[2]", random.random_range(-3..3)),
        9 => unit.along(["q[0]", "energy"], [double], [number]).map(drop),
        10 => unit.double([double, "q[0]"]).map(drop),
        11 => {
            let mut bytes = unit.bytes();
            let at = random.random_range(0..bytes.len());
            bytes[at] ^= 1 << random.random_range(0..8);
            // What can be read is a state; go back to the one before.
            let before = unit.bytes();
            unit.set_bytes(&bytes)?;
            unit.set_bytes(&before)
        }
        12 if random.random_bool(0.1) => unit.terminate(),
        13 if random.random_bool(0.2) => unit.reset(),
        _ => unit.through_bytes().map(drop),
    }
}

#[test]
fn a_call_that_fails_changes_nothing_whatever_came_before() {
    let mut random = StdRng::seed_from_u64(3);
    let (mut unit, mut failed, mut done) = (imported(), 0, 0);
    for k in 0..if cfg!(miri) { 100 } else { 20_000 } {
        let before = unit.bytes();
        match call(&mut unit, &mut random) {
            Ok(()) => done += 1,
            Err(Status::Error | Status::Discard) => {
                failed += 1;
                assert!(unit.bytes() == before, "call {k}");
            }
            Err(other) => panic!("call {k}: {other:?}"),
        }
    }
    assert!(failed > 20 && done > 20, "the control: calls of both kinds, {failed} and {done}");
    // The control: the bytes show what changes.
    unit.reset().unwrap();
    let before = unit.bytes();
    unit.set_double("c", 0.25).unwrap();
    assert_ne!(unit.bytes(), before);
}
