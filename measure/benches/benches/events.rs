//! What it costs to watch a run of Hénon and Heiles' system for one event: where nothing happens, and on the
//! section x = 0; times of interleaved runs.
//!
//! `cargo bench -p dalembert-benches --bench events`

use std::hint::black_box;

use dalembert::nalgebra::vector;
use dalembert::run::events::Crossing;
use dalembert::step::Flow;
use dalembert::{Discretise, Gauss, Midpoint, Splitting, State, Trapezoidal};
use dalembert_benches::interleaved::medians;
use dalembert_scenes::HenonHeiles;

const START: State<f64, 2> = State { q: vector![0.1, -0.2], p: vector![0.3, 0.25] };

fn main() {
    println!("| method | h | a step, ns | watched | on the section |");
    println!("|---|--:|--:|--:|--:|");
    row("`Gauss<8>`", Gauss::<8>, 0.25);
    row("`Gauss<4>`", Gauss::<4>, 0.1);
    row("splitting of order 6", Splitting::blanes_moan_6(), 0.25);
    row("splitting of order 4", Splitting::blanes_moan_4(), 0.1);
    row("`Midpoint`", Midpoint, 0.1);
    row("`Trapezoidal`", Trapezoidal, 0.05);
}

/// Nanoseconds of a step; a step that is watched, where nothing happens and on the section, over a step.
fn row<M: Copy>(name: &str, method: M, h: f64)
where
    HenonHeiles: Flow<M, 2, Scalar = f64>,
{
    let by = HenonHeiles {}.by(method, h);
    let end = |steps: usize| (steps as f64 - 0.5) * h;
    let alone = |steps: usize| {
        let mut run = by.run(START);
        for step in run.by_ref().take(steps) {
            step.expect("a step");
        }
        black_box(run.state().q);
    };
    let watched = |steps: usize| {
        let mut run = by.run(START);
        assert_eq!(run.watch(|at| [at.q[0] - 5.0]).until(end(steps)).count(), 0);
        black_box(run.state().q);
    };
    let section = |steps: usize| {
        let mut run = by.run(START);
        let events = run.watch(|at| [at.q[0]]).crossing([Crossing::Rising]).until(end(steps));
        black_box(events.map(|event| event.expect("an event").time).sum::<f64>());
    };
    let [alone, watched, section] = medians(&[&alone, &watched, &section]).try_into().expect("one of each");
    println!("| {name} | {h} | {:.0} | {:.2} | {:.2} |", alone * 1e9, watched / alone, section / alone);
}
