//! Tables from C: points at random, right and wrong, and what becomes of them.

use core::mem::MaybeUninit;
use core::ptr::{null, null_mut};
use std::ffi::CStr;

use dalembert::run::DrivenTrajectory;
use dalembert::system::{Interpolation, Table, TableError};
use dalembert::{Midpoint, State};
use dalembert_c::face::{Fields, interpolation_number};
use dalembert_c::{CWrongPoint, Status};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::bytes;
use crate::systems::tables::{Bead, Rocket, RocketAtTime, bead, rocket};

type Filled = <Rocket as Fields>::Given;
type Memory = MaybeUninit<rocket::CMemory>;

fn init(memory: &mut Memory, parameters: *const Filled) -> Status {
    let (size, layout) = (size_of::<Memory>(), rocket::HEADER.layout);
    unsafe { rocket::init_with(memory.as_mut_ptr(), size, layout, parameters, 0.05, 0.0, &[0.5], &[0.2]) }
}

fn wrong_point(parameters: *const Filled) -> CWrongPoint {
    let mut wrong = CWrongPoint { table: null(), status: 7, point: 7 };
    assert_eq!(unsafe { rocket::wrong_point(parameters, &mut wrong) }, Status::Ok);
    wrong
}

/// Points that may be wrong: two equal x, NaN, infinity, values that leap, a turn that does not close.
fn points<const K: usize>(random: &mut StdRng, of: Interpolation) -> [[f64; K]; 2] {
    let mut at = random.random_range(-1.0..1.0);
    let mut x = std::array::from_fn(|_| {
        at += random.random_range(0.1..1.0);
        at
    });
    let mut y: [f64; K] = std::array::from_fn(|_| random.random_range(0.0..20.0));
    if of == Interpolation::Periodic && random.random_range(0..8) != 0 {
        y[K - 1] = y[0];
    }
    let index = random.random_range(1..K);
    match random.random_range(0..16) {
        0 => x[index] = x[index - 1],
        1 => x[index] = x[index - 1] - 1.0,
        2 => x[index] = [f64::NAN, f64::INFINITY][random.random_range(0..2)],
        3 => y[index] = [f64::NAN, f64::NEG_INFINITY][random.random_range(0..2)],
        4 => {
            x[index] = x[index - 1].next_up();
            y[index] = 1e300;
        }
        _ => {}
    }
    [x, y]
}

/// The status and the point of an error, as the header tells them.
fn of(error: TableError) -> (Status, u32) {
    match error {
        TableError::NotIncreasing { index, .. } => (Status::PointsNotIncreasing, index as u32),
        TableError::KnotNotFinite { index, .. } | TableError::ValueNotFinite { index, .. } => {
            (Status::PointsNotFinite, index as u32)
        }
        TableError::NotPeriodic { .. } => (Status::PointsNotPeriodic, 0),
        TableError::TooSteep { index, .. } => (Status::PointsTooSteep, index as u32),
        other => panic!("{other}"),
    }
}

#[test]
fn points_are_the_table_that_rust_makes_of_them_or_are_refused_at_their_place() {
    let mut random = StdRng::seed_from_u64(21);
    let mut counts = [0; 38];
    for _ in 0..if cfg!(miri) { 60 } else { 6000 } {
        let kinds = [0; 2].map(|_| Interpolation::ALL[random.random_range(0..4)]);
        let [x, y] = points::<4>(&mut random, kinds[0]);
        let [rail_x, rail_y] = points::<5>(&mut random, kinds[1]);
        let straight = [0; 2].map(|_| random.random_bool(0.3));
        let mut filled = Rocket::ZERO.given();
        filled.mass = 2.0;
        (filled.thrust.x, filled.thrust.y) = (x, y);
        (filled.rail.x, filled.rail.y) = (rail_x, rail_y);
        filled.thrust.interpolation = interpolation_number(kinds[0]);
        filled.rail.interpolation = interpolation_number(kinds[1]);
        filled.thrust.straight_beyond = if straight[0] { random.random_range(1..9) } else { 0 };
        filled.rail.straight_beyond = straight[1].into();

        let beyond = |straight, table: Table<_>| if straight { table.straight_beyond() } else { table };
        let thrust = Table::through(kinds[0], x, y).map(|table| beyond(straight[0], table));
        let rail = Table::through(kinds[1], rail_x, rail_y);
        let mut memory = Memory::zeroed();
        let before = bytes(&memory);
        let (status, wrong) = (init(&mut memory, &filled), wrong_point(&filled));
        counts[status as usize] += 1;
        let (table, error) = match (&thrust, &rail) {
            (Err(error), _) => (c"thrust", *error),
            (_, Err(error)) => (c"rail", *error),
            (Ok(thrust), Ok(rail)) => {
                assert_eq!((status, wrong.status, wrong.point), (Status::Ok, 0, 0));
                assert!(wrong.table.is_null());
                let rail = if straight[1] { rail.straight_beyond() } else { *rail };
                let system = Rocket { mass: 2.0, thrust: *thrust, stages: 0, rail };
                runs_as(&mut memory, &system);
                continue;
            }
        };
        let (expected, point) = of(error);
        assert_eq!((status, wrong.status, wrong.point), (expected, expected as i32, point), "{error}");
        assert_eq!(unsafe { CStr::from_ptr(wrong.table) }, table);
        assert_eq!(bytes(&memory), before);
    }
    let seen: Vec<usize> = (0..counts.len()).filter(|&status| counts[status] > 0).collect();
    let least = if cfg!(miri) { 1 } else { 100 };
    assert!(cfg!(miri) || seen == [0, 33, 34, 35, 36], "{seen:?}");
    assert!(counts[0] > 30 * least / 2, "{counts:?}");
}

/// The run in the memory steps as that of `system`, bit by bit.
fn runs_as(memory: &mut Memory, system: &Rocket) {
    let start = State::from_velocity(&system.at_time(0.0), [0.5], [0.2]).unwrap();
    let mut run = DrivenTrajectory::<RocketAtTime<'static>, Midpoint, 1>::new(0.05, start);
    for k in 0..5 {
        let t = 0.05 * f64::from(k);
        let expected = run.advance(&system.at_time(t)).map_err(Status::from);
        let status = unsafe { rocket::step(memory.as_mut_ptr(), t, null_mut()) };
        assert_eq!(status, expected.err().unwrap_or(Status::Ok));
        let (mut q, mut p) = ([0.0], [0.0]);
        assert_eq!(unsafe { rocket::state(memory.as_ptr(), &mut q, &mut p) }, Status::Ok);
        let own = run.state();
        assert_eq!([q[0], p[0]].map(f64::to_bits), [own.q[0], own.p[0]].map(f64::to_bits));
    }
}

#[test]
fn wrong_tables_leave_a_run_as_it_was() {
    let mut good = Rocket::ZERO.given();
    good.mass = 2.0;
    good.thrust.y = [5.0, 30.0, 20.0, 0.0];
    let mut memory = Memory::zeroed();
    assert_eq!(init(&mut memory, &good), Status::Ok);
    let before = bytes(&memory);
    let set = |memory: &mut Memory, parameters: *const Filled| unsafe {
        rocket::set_parameters(memory.as_mut_ptr(), parameters)
    };
    for number in [0, 5, -1, i32::MAX] {
        let mut wrong = good;
        wrong.rail.interpolation = number;
        assert_eq!(set(&mut memory, &wrong), Status::NoInterpolation);
        let found = wrong_point(&wrong);
        assert_eq!((found.status, found.point), (Status::NoInterpolation as i32, 0));
        assert_eq!(unsafe { CStr::from_ptr(found.table) }, c"rail");
    }
    let mut wrong = good;
    wrong.thrust.x[3] = wrong.thrust.x[2];
    assert_eq!(set(&mut memory, &wrong), Status::PointsNotIncreasing);
    // What is no table is told of first.
    wrong.mass = f64::NAN;
    assert_eq!(set(&mut memory, &wrong), Status::ParameterNan);
    let mut found = CWrongPoint { table: null(), status: 7, point: 7 };
    assert_eq!(unsafe { rocket::wrong_point(null(), &mut found) }, Status::NullPointer);
    assert_eq!(unsafe { rocket::wrong_point(&good, null_mut()) }, Status::NullPointer);
    assert_eq!((found.status, found.point), (7, 7));
    assert_eq!(bytes(&memory), before);
    // The control: another table that is right changes the run.
    let mut other = good;
    other.thrust.interpolation = interpolation_number(Interpolation::Spline);
    assert_eq!(set(&mut memory, &other), Status::Ok);
    assert!(cfg!(miri) || bytes(&memory) != before);
}

/// Single precision: the points of a double one, its numbers rounded; what `f32` cannot hold is too steep.
#[test]
fn tables_of_single_precision_are_given_in_it() {
    let x = [-1.0, -0.5, 0.25, 0.5, 1.0, 2.0];
    let y = [1.0, 0.375, 0.125, 0.25, 0.75, 2.0];
    let mut filled = Bead::ZERO.given();
    (filled.height.x, filled.height.y) = (x.map(|x| x as f32), y.map(|y| y as f32));
    filled.height.interpolation = interpolation_number(Interpolation::Spline);
    let made = Bead::of(&filled).unwrap();
    assert_eq!(made.height, Table::spline(x, y).unwrap().single().unwrap());
    assert_eq!(made.given(), filled);
    filled.height.y[2] = 1e38;
    filled.height.x[3] = 0.25_f32.next_up();
    assert_eq!(Bead::of(&filled).map_err(Status::from), Err(Status::PointsTooSteep));
    let mut memory = MaybeUninit::<bead::CMemory>::zeroed();
    let (size, layout, at) = (size_of_val(&memory), bead::HEADER.layout, memory.as_mut_ptr());
    let (q, v) = ([0.25, 0.125], [0.0, 0.0]);
    let start =
        |filled: &<Bead as Fields>::Given| unsafe { bead::init_with(at, size, layout, filled, 0.01, &q, &v) };
    assert_eq!(start(&filled), Status::PointsTooSteep);
    assert_eq!(start(&made.given()), Status::Ok);
}
