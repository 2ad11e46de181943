//! Members that a stepping of one's own watches: events are records, and rows of parts.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use dalembert::run::Stop;
use dalembert::run::events::{Crossing, Watched as Next};
use dalembert::{Discretise, Gauss, State, rayleigh_system};
use dalembert_ensemble::{End, Ensemble, Failure, MemberError, Record, Slot, Stepping, one_by_one};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;

#[rayleigh_system(rule = gauss)]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// So many steps, each a record, watched for the angle 0 and for an angle beyond which nothing is known.
struct Watched {
    steps: u64,
}

impl Stepping<Pendulum, 1> for Watched {
    fn advance<V>(
        &self,
        members: &mut [Slot<Pendulum, V, 1>],
        observe: &impl Fn(&mut V, &Record<'_, Pendulum, 1>) -> ControlFlow<()>,
        stop: Stop<'_>,
    ) -> ControlFlow<()> {
        one_by_one(members, |number, system, start, value| {
            let mut run = system.by(Gauss::<4>, 0.25).run(*start);
            let mut watch = run.watch(|at| [at.q[0], if at.q[0] > 2.0 { f64::NAN } else { 1.0 }]);
            let mut last = Record { number, system, steps: 0, time: 0.0, state: *start, event: None };
            while last.steps < self.steps {
                if stop.is_asked() {
                    return ControlFlow::Break(());
                }
                let record = match watch.advance() {
                    Some(Ok(Next::Event(event))) => {
                        Record { time: event.time, state: event.state, event: Some(event.index), ..last }
                    }
                    Some(Ok(Next::Step(step))) => {
                        last = Record {
                            steps: last.steps + 1,
                            time: watch.run().time(),
                            state: step.state,
                            ..last
                        };
                        last
                    }
                    Some(Err(error)) => {
                        let last = Some(End { number, time: last.time, state: last.state });
                        return ControlFlow::Continue(Some(Failure { number, error: error.into(), last }));
                    }
                    None => break,
                };
                if observe(value, &record).is_break() {
                    break;
                }
            }
            ControlFlow::Continue(None)
        })
    }

    fn description(&self) -> String {
        format!("watched, {} steps", self.steps)
    }

    fn has_events(&self) -> bool {
        true
    }
}

fn member(number: u64) -> Result<(Pendulum, State<f64, 1>), dalembert::StepError> {
    // The last one goes over the top.
    Ok((Pendulum { r: 0.01 }, State { q: [0.1].into(), p: [0.75 * number as f64].into() }))
}

#[test]
fn events_are_records_and_rows_of_parts() {
    let study = Ensemble::new(member).stepped(Watched { steps: 60 });
    let add = |all: &mut Vec<_>, outcome: dalembert_ensemble::Outcome<Vec<_>, f64, 1>| {
        all.extend(outcome.value);
        if let Some(Failure { number, error, .. }) = outcome.failure {
            assert!(number == 3 && matches!(error, MemberError::Event(_)), "{number}: {error}");
        }
    };
    let observe = |rows: &mut Vec<_>, record: &Record<'_, Pendulum, 1>| {
        rows.push((record.number, record.time, record.state.q[0], record.event));
    };
    let seen = study.reduce(0..4, |_| Vec::new(), observe, Vec::new(), add).unwrap();
    for number in 0..3 {
        let mine: Vec<_> = seen.iter().filter(|row| row.0 == number).collect();
        assert!(mine.is_sorted_by(|a, b| a.1 <= b.1));
        let steps: Vec<_> = mine.iter().filter(|row| row.3.is_none()).collect();
        let passages = steps.windows(2).filter(|pair| pair[0].2.signum() != pair[1].2.signum()).count();
        let events: Vec<_> = mine.iter().filter(|row| row.3 == Some(0)).collect();
        assert!(steps.len() == 60 && events.len() == passages && passages > 2);
        assert!(events.iter().all(|row| row.2.abs() < 1e-14));
    }

    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("watched");
    let _ = fs::remove_dir_all(&folder);
    let written = study.parts(&folder).write(0..4).unwrap();
    assert_eq!((written.written, written.failed, written.failed_before), (1, 1, 0));
    let path = folder.join("members-000000000000-000000000004.parquet");
    let reader = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
    let rows: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    let names: Vec<_> = rows[0].get_column_iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["member", "t", "q0", "p0", "energy", "event", "error"]);
    let failed: Vec<_> = rows.iter().filter(|row| row.get_string(6).is_ok()).collect();
    assert!(failed.len() == 1 && failed[0].get_ulong(0).unwrap() == 3);
    assert!(failed[0].get_string(6).unwrap().contains("event function 1 is NaN"));
    // The last good state is that of the last record, unless it had none.
    assert_eq!(rows.len(), seen.len() + usize::from(seen.last().unwrap().0 != 3));
    for (row, &(number, time, q, event)) in rows.iter().zip(&seen) {
        let found = (row.get_ulong(0).unwrap(), row.get_double(1).unwrap(), row.get_double(2).unwrap());
        assert_eq!((found, row.get_int(5).ok()), ((number, time, q), event.map(|event| event as i32)));
    }
    // Failures of an earlier call are counted.
    let again = study.parts(&folder).write(0..4).unwrap();
    assert_eq!((again.found, again.failed, again.failed_before), (1, 1, 1));
}

struct Rod {
    r: f64,
    angle: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
impl Rod {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }

    fn events(&self, q: [f64; 1], _v: [f64; 1]) -> [f64; 2] {
        [q[0], if q[0] > 3.0 { f64::NAN } else { q[0] + self.angle }]
    }
}

fn rod(number: u64) -> Result<(Rod, State<f64, 1>), dalembert::StepError> {
    let rod = Rod { r: 0.01, angle: 0.1 + 0.05 * number as f64 };
    // The last ones go over the top, where an event function is NaN.
    let speed = if number < 37 { 0.04 * number as f64 } else { 2.5 };
    Ok((rod, State { q: [0.3].into(), p: [speed].into() }))
}

#[test]
fn members_that_are_watched_have_the_bits_of_their_runs_and_end_by_events() {
    let study = || Ensemble::new(rod).by(Gauss::<4>, 0.25).steps(90);
    let crossings = [Crossing::Rising, Crossing::Falling];
    let watched = study().every(7).watch(|at| at.events(), [false, true]).crossing(crossings);
    let observe = |rows: &mut Vec<_>, record: &Record<'_, Rod, 1>| {
        rows.push((record.time, record.state, record.event));
    };
    let (mut ended, mut failed, mut crossed) = (0, 0, 0);
    let outcomes = watched.reduce(0..40, |_| Vec::new(), observe, Vec::new(), Vec::push).unwrap();
    for outcome in &outcomes {
        let (system, start) = rod(outcome.number).unwrap();
        let mut run = system.by(Gauss::<4>, 0.25).run(start);
        let mut watch = run.watch(|at| at.events()).crossing(crossings).terminal([false, true]);
        let (mut expected, mut steps, mut failure) = (vec![(0.0, start, None)], 0, false);
        while steps < 90 {
            match watch.advance() {
                Some(Ok(Next::Event(event))) => expected.push((event.time, event.state, Some(event.index))),
                Some(Ok(Next::Step(step))) => {
                    steps += 1;
                    if steps % 7 == 0 || steps == 90 {
                        expected.push((watch.run().time(), step.state, None));
                    }
                }
                Some(Err(_)) => {
                    failure = true;
                    break;
                }
                None => {
                    expected.push((watch.run().time(), *watch.run().state(), None));
                    break;
                }
            }
        }
        assert_eq!(outcome.value, expected);
        assert_eq!(outcome.failure.is_some(), failure);
        ended += u32::from(steps < 90 && !failure);
        failed += u32::from(failure);
        crossed += expected.iter().filter(|row| row.2 == Some(0)).count();
    }
    // All kinds are there: ends on the way, runs to the end, failures, events that end nothing.
    assert!(ended > 5 && ended + failed < 35 && failed == 3 && crossed > 20, "{ended} {failed} {crossed}");
    // Steps are those of members that are not watched.
    let ends = study().ends(0..37).unwrap();
    let unended = study().watch(|at| at.events(), [false; 2]).ends(0..37).unwrap();
    assert_eq!(ends, unended);
    // Parts have the same events, and know them.
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("watched_members");
    let _ = fs::remove_dir_all(&folder);
    let of = |terminal| study().every(7).watch(|at| at.events(), terminal).crossing(crossings);
    assert_eq!(of([false, true]).parts(&folder).write(0..40).unwrap().written, 1);
    let path = of([false, true]).parts(&folder).paths(0..40).next().unwrap();
    let reader = SerializedFileReader::new(fs::File::open(path).unwrap()).unwrap();
    let rows: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    let events = rows.iter().filter_map(|row| Some((row.get_int(5).ok()?, row.get_double(1).ok()?)));
    let seen = outcomes.iter().flat_map(|outcome| &outcome.value);
    let seen = seen.filter_map(|(time, _, event)| event.map(|event| (event as i32, *time)));
    assert!(events.eq(seen));
    assert!(of([true, true]).parts(&folder).write(0..40).is_err());
}
