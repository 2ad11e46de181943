//! A unit of a system with tables: their points are parameters, set before the run and looked at when it
//! begins.

mod importer;

use dalembert::run::DrivenTrajectory;
use dalembert::system::{Interpolation, Table};
use dalembert::{Midpoint, State, rayleigh_system};
use dalembert_fmu::boundary::Status;
use importer::Imported;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

dalembert_fmu::parameters! {
    /// A rocket.
    pub struct Rocket {
        /// Mass.
        /// Unit: kg
        pub mass: f64,
        /// Thrust over the time.
        /// Unit: s, N
        pub thrust: Table<5>,
        /// Drag over the speed.
        pub drag: Table<4>,
    }
}

#[rayleigh_system]
impl Rocket {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.mass * v[0] * v[0] - 9.81 * self.mass * q[0]
    }

    fn force(&self, _q: [f64; 1], v: [f64; 1], t: f64) -> [f64; 1] {
        [self.thrust.at(t) - self.drag.at(v[0])]
    }
}

const fn made<const K: usize>(of: Interpolation, x: [f64; K], y: [f64; K]) -> Table<K> {
    match Table::through(of, x, y) {
        Ok(table) => table,
        Err(_) => panic!("not increasing"),
    }
}

const STATED: Rocket = Rocket {
    mass: 2.0,
    thrust: made(Interpolation::Monotone, [0.0, 0.25, 1.0, 2.0, 2.25], [0.0, 60.0, 50.0, 45.0, 0.0]),
    drag: made(Interpolation::Spline, [-20.0, 0.0, 10.0, 40.0], [-12.0, 0.0, 6.0, 30.0]).straight_beyond(),
};

dalembert_fmu::fmu! {
    rocket: Rocket, rule: Midpoint, step_size: 0.02, parameters: STATED, q: [0.0], v: [0.5]
}

fn imported() -> Imported {
    Imported::new(UNIT.description(), &UNIT.token())
}

/// q and p of the run in Rust after 20 steps.
fn in_rust(system: &Rocket) -> [f64; 2] {
    let start = State::from_velocity(&system.at_time(0.0), [0.0], [0.5]).unwrap();
    let mut run = DrivenTrajectory::<RocketAtTime, Midpoint, 1>::new(0.02, start);
    for _ in 0..20 {
        let view = system.at_time(run.time());
        run.advance(&view).unwrap();
    }
    [run.state().q[0], run.state().p[0]]
}

/// q and p of the unit after 20 steps.
fn stepped(unit: &mut Imported) -> [f64; 2] {
    unit.step(0.0, 0.4).unwrap();
    unit.double(["q[0]", "p[0]"]).unwrap()
}

#[test]
fn points_are_parameters_with_their_units() {
    let description = UNIT.description();
    for part in [
        r#"<Float64 name="thrust.x[1]" valueReference="4" description="Thrust over the time." causality="parameter" variability="fixed" initial="exact" unit="s" start="0.25""#,
        r#"name="thrust.y[1]" valueReference="9" description="Thrust over the time." causality="parameter" variability="fixed" initial="exact" unit="N" start="60.0""#,
        r#"name="drag.y[3]""#,
    ] {
        assert!(description.contains(part), "{part}: {description}");
    }
    assert!(!description.contains("drag.y[4]") && !description.contains("interpolation"));
    assert!(UNIT.description_fmi2().unwrap().contains(r#"name="drag.x[0]""#));
    let mut unit = imported();
    unit.start_at(0.0).unwrap();
    assert_eq!(unit.double(["thrust.x[4]", "thrust.y[0]", "drag.y[3]"]), Ok([2.25, 0.0, 30.0]));
    assert_eq!(stepped(&mut unit), in_rust(&STATED));
}

/// Points at random, set one by one in any order, right ones and wrong ones.
#[test]
fn points_that_are_set_are_the_table_of_rust_or_end_the_initialization() {
    let mut random = StdRng::seed_from_u64(5);
    let (mut right, mut wrong) = (0, 0);
    for _ in 0..if cfg!(miri) { 6 } else { 300 } {
        let mut at = random.random_range(-1.0..0.0);
        let mut x: [f64; 5] = std::array::from_fn(|_| {
            at += random.random_range(0.1..1.0);
            at
        });
        let y: [f64; 5] = std::array::from_fn(|_| random.random_range(0.0..60.0));
        let index = random.random_range(1..5);
        if random.random_bool(0.4) {
            x[index] = [x[index - 1], x[index - 1] - 0.1, f64::INFINITY][random.random_range(0..3)];
        }
        let mut unit = imported();
        let mut order: Vec<usize> = (0..10).collect();
        for last in (1..10).rev() {
            order.swap(last, random.random_range(0..=last));
        }
        for place in order {
            let (name, number) = if place < 5 {
                (format!("thrust.x[{place}]"), x[place])
            } else {
                (format!("thrust.y[{}]", place - 5), y[place - 5])
            };
            unit.set_double(&name, number).unwrap();
            if random.random_bool(0.1) {
                unit.through_bytes().unwrap();
            }
        }
        unit.enter_initialization(0.0).unwrap();
        assert_eq!(unit.double(["thrust.x[2]", "thrust.y[2]"]), Ok([x[2], y[2]]));
        match Table::monotone(x, y) {
            Ok(thrust) => {
                unit.exit_initialization().unwrap();
                assert_eq!(unit.set_double("thrust.y[0]", 1.0), Err(Status::Error), "the run has begun");
                unit.set_double("mass", 3.0).unwrap();
                unit.set_double("mass", 2.0).unwrap();
                assert_eq!(stepped(&mut unit), in_rust(&Rocket { thrust, ..STATED }));
                assert_ne!(unit.double(["q[0]", "p[0]"]), Ok(in_rust(&STATED)), "the control");
                right += 1;
            }
            Err(_) => {
                assert_eq!(unit.double(["energy"]), Err(Status::Error));
                assert_eq!(unit.exit_initialization(), Err(Status::Error));
                // It goes on with points that are right.
                let good: [f64; 5] = std::array::from_fn(|k| k as f64);
                for (k, x) in good.into_iter().enumerate() {
                    unit.set_double(&format!("thrust.x[{k}]"), x).unwrap();
                }
                unit.exit_initialization().unwrap();
                let thrust = Table::monotone(good, y).unwrap();
                assert_eq!(stepped(&mut unit), in_rust(&Rocket { thrust, ..STATED }));
                wrong += 1;
            }
        }
    }
    assert!(right > 2 && wrong > 0, "{right} {wrong}");
}

#[test]
fn saved_bytes_have_the_points() {
    let mut unit = imported();
    unit.set_double("drag.y[2]", 9.0).unwrap();
    unit.start_at(0.0).unwrap();
    unit.through_bytes().unwrap();
    let drag =
        made(Interpolation::Spline, [-20.0, 0.0, 10.0, 40.0], [-12.0, 0.0, 9.0, 30.0]).straight_beyond();
    assert_eq!(stepped(&mut unit), in_rust(&Rocket { drag, ..STATED }));
    // Points that are none are no state of a run.
    let bytes = unit.bytes();
    let place =
        bytes.windows(8).position(|word| word == 9.0_f64.to_le_bytes()).expect("the points are there");
    let mut wrong = bytes.clone();
    wrong[place..place + 8].copy_from_slice(&f64::INFINITY.to_le_bytes());
    assert_eq!(unit.set_bytes(&wrong), Err(Status::Error));
    assert_eq!(unit.set_bytes(&bytes), Ok(()));
}
