//! A section of Hénon and Heiles' problem: what its crossings of x = 0 cost, to given errors of the last.

use std::fmt::Write;

use anyhow::{Context, Result, ensure};
use dalembert::nalgebra::SVector;
use dalembert::run::events::Crossing;
use dalembert::step::Flow;
use dalembert::{Discretise, Gauss, Splitting, State};
use dalembert_scenes::HenonHeiles;
use serde::{Deserialize, Serialize};

use crate::frontier::{Point, time_to_reach};
use crate::measure::{Candidate, interleaved, timed};
use crate::peers::python::Python;
use crate::reference;

/// The name of its start and its end in `references.txt`.
const NAME: &str = "section";

/// Crossings of x = 0 from below, the last at the time of the reference.
const CROSSINGS: usize = 157;

/// Errors of the table.
const LEVELS: [f64; 4] = [1e-6, 1e-8, 1e-10, 1e-12];

/// A measured run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    pub method: String,
    /// Step size, or tolerance.
    pub setting: f64,
    /// Of all crossings, median.
    pub seconds: f64,
    /// Of the last crossing: of its time, and of y and v_y there.
    pub time_error: f64,
    pub position_error: f64,
    pub velocity_error: f64,
}

/// The last crossing: its time, y, v_y; and how many there were.
type Last = [f64; 4];

/// A run to a time, by steps of a size.
type Section = fn(State<f64, 2>, f64, f64) -> Result<Last>;

fn section<M: Copy>(method: M, start: State<f64, 2>, end: f64, h: f64) -> Result<Last>
where
    HenonHeiles: Flow<M, 2, Scalar = f64>,
{
    let mut run = HenonHeiles {}.by(method, h).run(start);
    let (mut last, mut count) = (None, 0.0);
    for event in run.watch(|at| [at.q[0]]).crossing([Crossing::Rising]).until(end) {
        last = Some(event?);
        count += 1.0;
    }
    let last = last.context("no crossing")?;
    Ok([last.time, last.state.q[1], last.state.p[1], count])
}

const METHODS: [(&str, Section); 5] = [
    ("Blanes–Moan 6", |start, end, h| section(Splitting::blanes_moan_6(), start, end, h)),
    ("Blanes–Casas–Escorihuela 8", |start, end, h| {
        section(Splitting::blanes_casas_escorihuela_8(), start, end, h)
    }),
    ("Gauss, 4 stages", |start, end, h| section(Gauss::<4>, start, end, h)),
    ("Gauss, 6 stages", |start, end, h| section(Gauss::<6>, start, end, h)),
    ("Gauss, 8 stages", |start, end, h| section(Gauss::<8>, start, end, h)),
];

/// All methods and settings, in turns.
///
/// # Errors
/// The reference is missing or unusable.
pub fn measure(python: Option<&Python>) -> Result<Vec<Record>> {
    let reference = reference::of(NAME)?;
    let [q, v] = [&reference.start_q, &reference.start_v].map(|x| SVector::<f64, 2>::from_column_slice(x));
    // p = v.
    let start = State { q, p: v };
    // The time of the reference is a number of `f64` next to the crossing: there x = v_x δ.
    let [x, vx] = [reference.end_q[0], reference.end_v[0]];
    let exact = [reference.time - x / vx, reference.end_q[1], reference.end_v[1]];
    ensure!(x.abs() < 1e-12 && vx > 0.0, "the reference does not end on the section");
    // A little later than the last crossing, so that nothing depends on its error.
    let end = reference.time + 0.5;
    let mut candidates: Vec<Candidate<'_, Last>> = Vec::new();
    for (method, run) in METHODS {
        for k in -2..8 {
            let h = 2_f64.powf(-0.5 * f64::from(k));
            let run = timed(move || run(start, end, h), Ok);
            candidates.push(Candidate { method, setting: h, run });
        }
    }
    if let Some(python) = python {
        for &method in &python.events {
            for tolerance in (6..16).map(|k| 10_f64.powi(-k)).chain([f64::EPSILON]) {
                let run = move |repeats| {
                    let (seconds, ends) = python.run::<4>(method, NAME, tolerance, repeats, 1)?;
                    Ok((seconds, *ends.first().context("no crossing")?))
                };
                candidates.push(Candidate { method, setting: tolerance, run: Box::new(run) });
            }
        }
    }
    let mut records = Vec::new();
    for measured in interleaved(candidates) {
        let [time, y, vy, count] = measured.end;
        if count == CROSSINGS as f64 {
            let [of_time, of_y, of_vy] = [time - exact[0], y - exact[1], vy - exact[2]].map(f64::abs);
            records.push(Record {
                method: measured.method.into(),
                setting: measured.setting,
                seconds: measured.seconds,
                time_error: of_time,
                position_error: of_y,
                velocity_error: of_vy,
            });
        }
    }
    Ok(records)
}

/// The table: µs of all crossings, by the error of the last one's time.
///
/// # Errors
/// None but of writing.
pub fn table(page: &mut String, records: &[Record]) -> Result<()> {
    writeln!(
        page,
        "The first {CROSSINGS} crossings of x = 0 from below, in 1000 units of time, by an orbit of energy 0.0547: µs of the whole run, by the error of \
         the time of the last. heyoka calls back into Python at each crossing: once the time is taken there alone, once the state as well, \
         which this project's events have.\n"
    )?;
    writeln!(page, "| method | {} |", LEVELS.map(|error| format!("{error:e}")).join(" | "))?;
    writeln!(page, "|---|{}", "---|".repeat(LEVELS.len()))?;
    let mut methods: Vec<&str> = Vec::new();
    for record in records {
        if !methods.contains(&record.method.as_str()) {
            methods.push(&record.method);
        }
    }
    for method in methods {
        write!(page, "| {method} |")?;
        for error in LEVELS {
            let runs = records.iter().filter(|record| record.method == method);
            let runs = runs.map(|run| Point { seconds: run.seconds, error: run.time_error });
            match time_to_reach(error, runs) {
                Some(seconds) => write!(page, " {:.0} |", seconds * 1e6)?,
                None => write!(page, " – |")?,
            }
        }
        writeln!(page)?;
    }
    Ok(())
}
