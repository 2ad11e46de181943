//! Sliders run to rest, or drawn along by belts, beside their motion from event to event.

use std::fmt::Write as _;

use anyhow::Result;
use dalembert::{Discretise, Proximal, State};
use dalembert_tests::sliders::{Drawn, Motion};

/// Step sizes.
const STEPS: [f64; 5] = [0.04, 0.02, 0.01, 0.005, 0.0025];
/// The time of a motion.
const TIME: f64 = 100.0;

/// What one step size makes of a motion.
struct Run {
    /// The largest error of a place at the end.
    off: f64,
    /// The error of the time from which all stands, where it does.
    late: Option<f64>,
    /// What a step refused.
    refused: Option<String>,
}

fn run(drawn: &Drawn, motion: &Motion<'_>, h: f64) -> Result<Run> {
    let start = State::from_velocity(&drawn.sliders, drawn.q, drawn.v)?;
    let (mut state, mut rests_from) = (start, None);
    for (k, step) in drawn.sliders.by(Proximal, h).run(start).take((TIME / h).round() as usize).enumerate() {
        let step = match step {
            Ok(step) => step,
            Err(error) => return Ok(Run { off: f64::NAN, late: None, refused: Some(error.to_string()) }),
        };
        let moves = step.velocity.amax() > 0.0;
        rests_from = if moves { None } else { rests_from.or(Some(k as f64 * h)) };
        state = step.state;
    }
    let late = rests_from.filter(|_| motion.rests()).map(|time| time - motion.last_event);
    Ok(Run { off: (motion.q - state.q).amax(), late, refused: None })
}

/// The tables: on the ground, and on belts.
pub fn tables(count: u64, first: u64) -> Result<String> {
    let mut text = String::new();
    for (title, has_belts) in [("On the ground", false), ("On belts", true)] {
        let mut found: [Vec<Run>; STEPS.len()] = Default::default();
        let (mut rest, mut events) = (0, 0);
        let mut alone = [[f64::NAN; STEPS.len()]; 2].map(|row| row.map(|_| Vec::new()));
        for seed in first..first + count {
            let drawn = Drawn::of(seed, has_belts);
            let mut motion = Motion::new(&drawn.sliders, drawn.q, drawn.v);
            motion.advance(TIME);
            rest += usize::from(motion.rests());
            events += motion.events;
            for (k, (found, h)) in found.iter_mut().zip(STEPS).enumerate() {
                let run = run(&drawn, &motion, h)?;
                if let Some(refused) = &run.refused {
                    println!("seed {seed}, h = {h}: {refused}");
                }
                alone[usize::from(drawn.n > 1)][k].push(run.off);
                found.push(run);
            }
        }
        writeln!(
            text,
            "**{title}**: {count} sliders from seed {first} on, {events} times at which one stops or breaks loose, {rest} at rest \
             at t = {TIME}.\n"
        )?;
        text += "| h | refused | error of q at the end: median | largest | one mass: median | several: median | error of the \
                 time of rest over h: median | largest | not at rest |\n|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
        for (k, (found, h)) in found.iter().zip(STEPS).enumerate() {
            let refused = found.iter().filter(|run| run.refused.is_some()).count();
            let off: Vec<f64> = found.iter().map(|run| run.off).filter(|off| off.is_finite()).collect();
            let late: Vec<f64> = found.iter().filter_map(|run| run.late).map(|late| late.abs() / h).collect();
            writeln!(
                text,
                "| {h} | {refused} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.2} | {:.1} | {} |",
                median(&off),
                largest(&off),
                median(&alone[0][k]),
                median(&alone[1][k]),
                median(&late),
                largest(&late),
                rest - late.len(),
            )?;
        }
        text.push('\n');
    }
    Ok(text)
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NAN, f64::max)
}
