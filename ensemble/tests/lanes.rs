//! In lanes, members are what they are one by one: states, records, failures, and those that have arrived.

use dalembert::system::{Interpolation, Table, TableSlice};
use dalembert::{Discretise, Gauss, Midpoint, Splitting, State, StepError, rayleigh_system};
use dalembert_ensemble::{Ensemble, Outcome, Record};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Hénon and Heiles' potential with drag: above the energy 1/6 there are three ways out, to infinity.
#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
fn henon_heiles(q: [f64; 2], v: [f64; 2], depth: f64, r: f64) -> (f64, f64) {
    let (x, y) = (q[0], q[1]);
    let speed = v[0] * v[0] + v[1] * v[1];
    (0.5 * speed - 0.5 * (x * x + y * y) - depth * (x * x * y - y * y * y / 3.0), 0.5 * r * speed)
}

fn member(number: u64) -> Result<(HenonHeiles, State<f64, 2>), StepError> {
    let mut random = ChaCha8Rng::seed_from_u64(6);
    random.set_stream(number);
    let mut any = |size: f64| random.random_range(-size..size);
    let r = if number.is_multiple_of(3) { 0.0 } else { any(0.05) + 0.05 };
    let system = HenonHeiles { depth: 1.0 + any(0.2), r };
    let speed = match number % 41 {
        7 => return Err(StepError::StepSize { h: 0.0 }),
        12 => f64::NAN,
        _ => any(0.8),
    };
    Ok((system, State { q: [any(0.4), any(0.4)].into(), p: [speed, any(0.8)].into() }))
}

/// Every record of every member, by its bits, and how it ended.
fn records(
    steps: u64,
    every: Option<u64>,
    stops: bool,
    in_lanes: bool,
    members: u64,
) -> Vec<(u64, Vec<[u64; 6]>, String)> {
    let mut study = Ensemble::new(member).by(Splitting::blanes_moan_6(), 0.2).steps(steps);
    if let Some(stride) = every {
        study = study.every(stride);
    }
    let observe = |kept: &mut Vec<[u64; 6]>, record: &Record<'_, HenonHeiles, 2>| {
        let State { q, p } = record.state;
        kept.push([
            record.steps,
            record.time.to_bits(),
            q[0].to_bits(),
            q[1].to_bits(),
            p[0].to_bits(),
            p[1].to_bits(),
        ]);
    };
    let add = |all: &mut Vec<_>, Outcome { number, value, failure }: Outcome<_, f64, 2>| {
        all.push((number, value, format!("{failure:?}")));
    };
    let has_left = move |record: &Record<'_, HenonHeiles, 2>| stops && record.state.q.norm() > 2.0;
    let study = study.stop_when(has_left);
    if in_lanes {
        study.in_lanes().reduce(0..members, |_| Vec::new(), observe, Vec::new(), add).unwrap()
    } else {
        study.reduce(0..members, |_| Vec::new(), observe, Vec::new(), add).unwrap()
    }
}

#[test]
fn lanes_change_no_bit_of_any_member() {
    let (mut compared, mut failed, mut arrived) = (0, 0, 0);
    for (steps, every, stops, members) in [
        (60, None, false, 700),
        (60, Some(7), true, 300),
        (150, Some(1), true, 70),
        (0, None, false, 40),
        (5, Some(9), false, 1),
    ] {
        let (lanes, alone) =
            (records(steps, every, stops, true, members), records(steps, every, stops, false, members));
        for (lane, alone) in lanes.iter().zip(&alone) {
            assert_eq!(lane, alone);
        }
        assert_eq!(lanes.len() as u64, members);
        compared += lanes.len();
        failed += alone.iter().filter(|(_, _, failure)| failure != "None").count();
        arrived += alone
            .iter()
            .filter(|(_, kept, failure)| failure == "None" && kept.last().is_some_and(|last| last[0] < steps))
            .count();
    }
    // Starts that are none, numbers that are none, motions to infinity, members that have left: all were
    // there.
    assert!(compared == 1111 && failed > 100 && arrived > 50, "{compared} {failed} {arrived}");
}

/// Members that leave early, with others in their lanes after them: the same on any number of threads.
#[test]
fn the_number_of_threads_changes_no_bit_of_members_in_lanes() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| records(120, Some(1), true, true, 700))
    };
    let one = on(1);
    let steps: Vec<u64> = one.iter().filter_map(|(_, kept, _)| kept.last().map(|last| last[0])).collect();
    assert!(steps.iter().any(|&steps| steps < 20) && steps.contains(&120));
    for threads in [2, 3, 7] {
        assert!(on(threads) == one, "{threads} threads");
    }
    assert!(records(120, Some(1), true, false, 700) == one, "one by one");
}

/// Two links with friction, each member with lengths of its own: the mass depends on q.
#[rayleigh_system(rule = [midpoint, gauss], lanes = [midpoint, gauss])]
fn links(q: [f64; 2], v: [f64; 2], l: [f64; 2], r: f64) -> (f64, f64) {
    let coupling = l[0] * l[1] * v[0] * v[1] * (q[0] - q[1]).cos();
    let kinetic = (l[0] * v[0]).powi(2) + 0.5 * (l[1] * v[1]).powi(2) + coupling;
    (kinetic + 9.81 * (2.0 * l[0] * q[0].cos() + l[1] * q[1].cos()), 0.5 * r * (v[1] - v[0]).powi(2))
}

/// A pendulum whose pivot is shaken, pushed by an input.
struct Shaken {
    m: f64,
    r: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss], lanes = [explicit, gauss])]
impl Shaken {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * self.m * v[0] * v[0] + (1.0 + 0.2 * (3.0 * t).sin()) * q[0].cos()
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1], t: f64) -> [f64; 1] {
        [u[0] * t.cos()]
    }
}

/// Each with an input and a time of its own, by a splitting and by a Gauss rule. Lanes are given to the next
/// where members have arrived, so that they stand at other times.
#[test]
fn members_have_times_of_their_own() {
    let systems: Vec<Shaken> =
        (0..90).map(|member| Shaken { m: 1.0 + 0.01 * f64::from(member), r: 0.1 }).collect();
    let member = |number: u64| {
        let t = 0.3 * number as f64;
        let speed = if number % 37 == 5 { f64::NAN } else { 0.02 * number as f64 };
        let view = systems[number as usize].driven([0.1 * (number % 7) as f64], t);
        Ok((view, State { q: [0.5].into(), p: [speed].into() }))
    };
    let study = || Ensemble::new(member).by(Splitting::blanes_moan_6(), 0.2).steps(100);
    let study = || study().stop_when(|record: &Record<'_, DrivenShaken<'_>, 1>| record.state.q[0] > 2.5);
    let text = |ends: Vec<_>| ends.iter().map(|end| format!("{end:?}")).collect::<Vec<_>>();
    let by_splitting = text(study().in_lanes().ends(0..90).unwrap());
    assert_eq!(by_splitting, text(study().ends(0..90).unwrap()));
    let study = || Ensemble::new(member).by(Gauss::<4>, 0.2).steps(100);
    let by_gauss = text(study().in_lanes().ends(0..90).unwrap());
    assert_eq!(by_gauss, text(study().ends(0..90).unwrap()));
    for ends in [by_splitting, by_gauss] {
        assert_eq!(ends.iter().filter(|end| end.starts_with("Err")).count(), 3);
    }
    // The control: at another time it is another motion.
    let start = State { q: [0.5].into(), p: [0.1].into() };
    let end = |t| systems[0].driven([0.3], t).by(Gauss::<4>, 0.2).run(start).nth(99).unwrap().unwrap().state;
    assert_ne!(end(1.0), end(1.0_f64.next_up()));
}

/// By the midpoint rule: the ends of all members, by their bits, and their failures.
#[test]
fn members_by_the_midpoint_rule_are_their_own_runs() {
    let member = |number: u64| {
        let links = Links { l: [1.0, 0.5 + 1e-3 * number as f64], r: 0.1 };
        let speed = if number % 37 == 5 { f64::NAN } else { 0.01 * number as f64 };
        Ok((links, State { q: [1.0, 2.0].into(), p: [speed, 0.0].into() }))
    };
    let study = || Ensemble::new(member).by(Midpoint, 0.02).steps(100);
    let text = |ends: Vec<_>| ends.iter().map(|end| format!("{end:?}")).collect::<Vec<_>>();
    let (in_lanes, alone) = (study().in_lanes().ends(0..90).unwrap(), study().ends(0..90).unwrap());
    let (in_lanes, alone) = (text(in_lanes), text(alone));
    assert_eq!(in_lanes, alone);
    assert_eq!(in_lanes.iter().filter(|end| end.starts_with("Err")).count(), 3);
}

/// Gauss rules, solved to rounding and for an error: the ends of all members, by their bits, and their
/// failures.
#[test]
fn members_by_gauss_rules_are_their_own_runs() {
    let member = |number: u64| {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        random.set_stream(number);
        let mut any = |range: core::ops::Range<f64>| random.random_range(range);
        let links = Links { l: [any(0.5..1.5), any(0.5..1.5)], r: any(0.0..0.1) };
        let speed = if number % 37 == 5 { f64::NAN } else { any(-2.0..2.0) };
        Ok((links, State { q: [any(-2.0..2.0), any(-2.0..2.0)].into(), p: [speed, any(-2.0..2.0)].into() }))
    };
    let ends = |error: Option<f64>, in_lanes: bool| {
        let mut study = Ensemble::new(member).by(Gauss::<4>, 0.1).steps(40);
        if let Some(error) = error {
            study = study.solved_for(error);
        }
        let ends = if in_lanes { study.in_lanes().ends(0..150) } else { study.ends(0..150) };
        ends.unwrap().iter().map(|end| format!("{end:?}")).collect::<Vec<_>>()
    };
    for error in [None, Some(1e-5)] {
        assert_eq!(ends(error, true), ends(error, false), "{error:?}");
    }
    // Positive controls: what is left unsolved is seen, and so are members that fail.
    assert_ne!(ends(None, true), ends(Some(1e-5), true));
    assert!(ends(None, true).iter().any(|end| end.starts_with("Err")));
}

/// Members that all leave, in a run that has no end of its own: until they arrive, or fail on the way.
#[test]
fn runs_of_any_length_end_with_their_members() {
    let member = |number: u64| {
        let start = State { q: [0.0, 1.5 + 1e-2 * number as f64].into(), p: [0.0, 0.5].into() };
        Ok((HenonHeiles { depth: 1.0, r: 0.0 }, start))
    };
    for steps in [u64::MAX, u64::MAX - 1] {
        let study = || Ensemble::new(member).by(Splitting::blanes_moan_6(), 0.2).steps(steps);
        let has_left = |record: &Record<'_, HenonHeiles, 2>| record.state.q[1] > 3.0;
        let study_to_there = || study().every(1).stop_when(has_left);
        let arrived = study_to_there().in_lanes().ends(0..40).unwrap();
        assert_eq!(arrived, study_to_there().ends(0..40).unwrap());
        assert!(arrived.iter().all(|end| end.is_ok_and(|end| end.state.q[1] > 3.0)));
        let failed = study().in_lanes().ends(0..40).unwrap();
        assert_eq!(failed, study().ends(0..40).unwrap());
        assert!(failed.iter().all(Result::is_err));
    }
}

/// A cart on a curve of its own: another table, of another kind, for each member.
#[rayleigh_system(lanes = midpoint)]
fn cart(q: [f64; 2], v: [f64; 2], spring: Table<5>, drag: TableSlice<'static>) -> (f64, f64) {
    let potential = spring.at(q[0]) + 0.5 * (q[0] * q[0] + q[1] * q[1] - q[0] * q[1]);
    (0.5 * (v[0] * v[0] + v[1] * v[1]) - potential, 0.5 * drag.at(q[1]) * v[0] * v[0])
}

#[test]
fn members_with_tables_of_their_own_are_their_own_runs() {
    static X: [f64; 4] = [-1.0, -0.2, 0.5, 1.5];
    let member = |number: u64| -> Result<(Cart, State<f64, 2>), StepError> {
        let mut random = ChaCha8Rng::seed_from_u64(8);
        random.set_stream(number);
        let mut y = [0.0; 5].map(|_| random.random_range(-0.5..0.5));
        y[4] = y[0];
        // A linear one has a force that jumps, across which some steps have no solution.
        let of = Interpolation::ALL[(1 + number % 3) as usize];
        let spring = Table::through(of, [-1.5, -0.6, 0.1, 0.8, 1.6], y).expect("increasing x");
        let drag = [0.1, 0.3, 0.2, 0.1].map(|y| y * (1 + number % 5) as f64);
        let drag = TableSlice::linear(&X, &drag, vec![[0.0; 4]; 4].leak()).expect("increasing x");
        let start = State { q: [0.4, -0.3].into(), p: [random.random_range(-1.0..1.0), 0.2].into() };
        Ok((Cart { spring, drag }, start))
    };
    let study = || Ensemble::new(member).by(Midpoint, 0.05).steps(100);
    let (ends, in_lanes) = (study().ends(0..300).unwrap(), study().in_lanes().ends(0..300).unwrap());
    assert_eq!(ends, in_lanes);
    assert!(ends.iter().all(Result::is_ok));
    // The control: with the tables of the next member it is another motion.
    let exchanged = |number: u64| Ok((member(number + 1)?.0, member(number)?.1));
    let others = Ensemble::new(exchanged).by(Midpoint, 0.05).steps(100).in_lanes().ends(0..300).unwrap();
    assert!(ends.iter().zip(&others).all(|(own, other)| own != other));
}
