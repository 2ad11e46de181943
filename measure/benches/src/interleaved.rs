//! Timing in turns.

use std::time::Instant;

const ROUNDS: usize = 201;

/// Seconds that one candidate runs in one round: short, so that few rounds are interrupted by other programs.
const TURN: f64 = 3e-4;

fn seconds(candidate: &dyn Fn(usize), steps: usize) -> f64 {
    let start = Instant::now();
    candidate(steps);
    start.elapsed().as_secs_f64()
}

/// Median seconds per step of each candidate, run in turns: what slows the machine slows all.
///
/// A candidate takes the number of steps to run.
pub fn medians(candidates: &[&dyn Fn(usize)]) -> Vec<f64> {
    let steps: Vec<usize> = candidates
        .iter()
        .map(|candidate| {
            let mut steps = 16;
            while seconds(candidate, steps) < TURN / 2.0 {
                steps *= 2;
            }
            (steps as f64 * TURN / seconds(candidate, steps)).ceil() as usize
        })
        .collect();
    medians_over(candidates, &steps)
}

/// The same with the `steps` that each candidate runs in one turn given.
pub fn medians_over(candidates: &[&dyn Fn(usize)], steps: &[usize]) -> Vec<f64> {
    let mut times = vec![Vec::with_capacity(ROUNDS); candidates.len()];
    for _ in 0..ROUNDS {
        for ((candidate, &steps), times) in candidates.iter().zip(steps).zip(&mut times) {
            times.push(seconds(candidate, steps) / steps as f64);
        }
    }
    times
        .into_iter()
        .map(|mut times| {
            times.sort_by(f64::total_cmp);
            times[ROUNDS / 2]
        })
        .collect()
}
