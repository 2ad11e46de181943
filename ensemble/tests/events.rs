//! Members that a stepping of one's own watches: events are records, and rows of parts.

use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

use dalembert::run::Stop;
use dalembert::run::events::Watched as Next;
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
