//! Members that panic stand in the result, with their numbers, and the others go on.

use std::panic::{AssertUnwindSafe, catch_unwind};

use dalembert::{Gauss, Midpoint, Splitting, State, StepError, rayleigh_system};
use dalembert_ensemble::{Ensemble, Failure, MemberError, Outcome, Record};

/// A spring, whose stiffness there may not be.
struct Springs {
    which: usize,
}

#[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = num_dual)]
impl Springs {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let k = [1.0, 2.0][self.which];
        0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0]
    }
}

/// Member 70 has a spring that is not there, and the making of 80 panics.
fn member(number: u64) -> Result<(Springs, State<f64, 1>), StepError> {
    assert!(number != 80, "there is no member 80");
    let which = if number == 70 { 2 } else { (number % 2) as usize };
    Ok((Springs { which }, State { q: [0.1 * number as f64].into(), p: [0.0].into() }))
}

#[test]
fn a_member_that_panics_stands_in_the_result_and_the_others_go_on() {
    let study = || Ensemble::new(member).by(Midpoint, 0.1).steps(100).every(30);
    let alone = study().ends(0..100).unwrap();
    for (number, end) in alone.iter().enumerate() {
        match end {
            Ok(end) => assert!(end.number == number as u64 && end.time > 9.9),
            Err(failure) => {
                assert!([70, 80].contains(&number) && failure.number == number as u64);
                assert!(failure.error == MemberError::Panicked && failure.last.is_some() == (number == 70));
                assert!(failure.to_string().contains(&format!("member {number}")), "{failure}");
            }
        }
    }
    assert_eq!(alone.iter().filter(|end| end.is_err()).count(), 2);
    let to_error = Ensemble::new(member).to_error(1e-3, 1.0).ends(0..100).unwrap();
    for (number, end) in to_error.iter().enumerate() {
        assert_eq!(end.err().map(|failure| failure.error), alone[number].err().map(|failure| failure.error));
    }
}

/// A spring cut into so many pieces, none of which there may be.
struct Cut {
    pieces: u32,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], lanes = [explicit, midpoint, gauss])]
impl Cut {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let k = (12 / self.pieces) as f64;
        0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0]
    }
}

/// Members that panic in lanes: one of the first, two of one group, the last.
const CUT: [u64; 5] = [3, 40, 41, 75, 99];

fn cut(number: u64) -> Result<(Cut, State<f64, 1>), StepError> {
    let pieces = if CUT.contains(&number) { 0 } else { 1 + (number % 4) as u32 };
    Ok((Cut { pieces }, State { q: [0.01 * number as f64].into(), p: [0.0].into() }))
}

#[test]
fn members_that_panic_in_lanes_fail_as_they_do_one_by_one() {
    macro_rules! compare {
        ($($method:expr),+) => {$(
            for stride in [7, 1000] {
                let study = || Ensemble::new(cut).by($method, 0.1).steps(100).every(stride);
                let alone = study().ends(0..100).unwrap();
                let failed = |ends: &[Result<_, Failure<f64, 1>>]| -> Vec<u64> {
                    ends.iter().filter_map(|end| end.as_ref().err()).map(|failure| failure.number).collect()
                };
                assert_eq!(failed(&alone), CUT);
                let lanes = study().in_lanes().ends(0..100).unwrap();
                assert_eq!(lanes, alone);
                // Each record is observed once.
                let records = |total: &mut Vec<u64>, outcome: Outcome<u64, f64, 1>| total.push(outcome.value);
                let count = |seen: &mut u64, _: &Record<'_, Cut, 1>| *seen += 1;
                let one_by_one = study().reduce(0..100, |_| 0, count, Vec::new(), records).unwrap();
                let in_lanes = study().in_lanes().reduce(0..100, |_| 0, count, Vec::new(), records).unwrap();
                assert_eq!(in_lanes, one_by_one);
            }
        )+};
    }
    compare!(Midpoint, Gauss::<3>, Splitting::blanes_moan_4());
}

/// Observers are the caller's, one by one as in lanes: their panics are no failures of members.
#[test]
fn an_observer_that_panics_is_heard() {
    let study = || Ensemble::new(cut).by(Midpoint, 0.1).steps(100).every(10);
    let observe = |_: &mut (), record: &Record<'_, Cut, 1>| assert!(record.number != 17 || record.steps < 50);
    let add = |total: &mut u64, _: Outcome<(), f64, 1>| *total += 1;
    let alone = catch_unwind(AssertUnwindSafe(|| study().reduce(0..100, |_| (), observe, 0, add)));
    let lanes = catch_unwind(AssertUnwindSafe(|| study().in_lanes().reduce(0..100, |_| (), observe, 0, add)));
    assert!(alone.is_err() && lanes.is_err());
    // Control: without it all are counted, those that fail among them.
    assert_eq!(study().in_lanes().reduce(0..100, |_| (), |_, _| {}, 0, add).unwrap(), 100);
}

/// Their rows have the error, and no energy.
#[cfg(feature = "parquet")]
#[test]
fn members_that_panic_have_rows_in_parts() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("panics");
    let _ = std::fs::remove_dir_all(&folder);
    let alone = || Ensemble::new(cut).by(Midpoint, 0.1).steps(20).every(10);
    let written = alone().parts(&folder).members_per_part(50).write(0..100).unwrap();
    assert_eq!((written.written, written.failed), (2, CUT.len() as u64));
    let found = alone().parts(&folder).members_per_part(50).write(0..100).unwrap();
    assert_eq!((found.found, found.failed_before), (2, CUT.len() as u64));
    // In lanes they are other studies by name, of the same members.
    std::fs::remove_dir_all(&folder).unwrap();
    let written = alone().in_lanes().parts(&folder).members_per_part(50).write(0..100).unwrap();
    assert_eq!(written.failed, CUT.len() as u64);
    std::fs::remove_dir_all(&folder).unwrap();
}
