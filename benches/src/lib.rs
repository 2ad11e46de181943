//! Benchmarks of dalembert: scenes, the same steps by hand, and interleaved timing. See `benches/`.

pub mod by_hand;
pub mod scenes;

use std::time::Instant;

/// Median seconds of each candidate, run in turns: what slows the machine slows all.
pub fn interleaved<const K: usize>(candidates: [&dyn Fn(); K]) -> [f64; K] {
    const ROUNDS: usize = 41;
    let mut times = [[0.0; ROUNDS]; K];
    for round in 0..ROUNDS {
        for (candidate, times) in candidates.iter().zip(&mut times) {
            let start = Instant::now();
            candidate();
            times[round] = start.elapsed().as_secs_f64();
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    })
}
