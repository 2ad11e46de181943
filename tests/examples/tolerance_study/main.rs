//! What came of the errors asked for, over random motions: writes `docs/error-asked-for.md`.
//!
//! ```text
//! cargo study tolerance_study [seed motions]
//! ```
//!
//! With a seed and a number of motions it prints every run of that collection instead.

mod page;

use std::env::args;
use std::path::Path;
use std::thread;

use anyhow::{Context, Result};
use dalembert_tests::motions::{Motion, Outcome, collection};
use page::Collection;

/// The errors asked for.
pub const TOLERANCES: [f64; 6] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];

/// The collections: the code was written with an eye on the first two, the others were run once.
const SEEDS: [u64; 4] = [1, 4711, 20_261, 777_013];

/// Motions of each, and how many of them are compared to all fixed step sizes.
const MOTIONS: usize = 252;
const COMPARED: usize = 42;

/// A run and the evaluations of the cheapest fixed choice, where that was looked for.
pub type Run = (&'static str, f64, Outcome, Option<f64>);

fn runs(motion: &Motion, is_compared: bool) -> Vec<Run> {
    let cheapest = if is_compared { motion.cheapest(&TOLERANCES) } else { vec![None; TOLERANCES.len()] };
    let each = TOLERANCES.into_iter().zip(cheapest);
    each.map(|(tolerance, best)| (motion.family, tolerance, motion.ask(tolerance), best.map(|best| best.0)))
        .collect()
}

fn main() -> Result<()> {
    let mut numbers = args().skip(1).map(|text| text.parse::<u64>());
    if let (Some(seed), Some(count)) = (numbers.next(), numbers.next()) {
        for motion in collection(seed?, count? as usize) {
            for (family, tolerance, outcome, _) in runs(&motion, false) {
                println!("{family}, {}: {tolerance:.0e}: {outcome:?}", motion.what);
            }
        }
        return Ok(());
    }
    let of_seed = |seed: u64| {
        let motions = collection(seed, MOTIONS);
        let all = motions.iter().enumerate();
        Collection { seed, runs: all.flat_map(|(i, motion)| runs(motion, i < COMPARED)).collect() }
    };
    let collections = thread::scope(|scope| {
        let running = SEEDS.map(|seed| scope.spawn(move || of_seed(seed)));
        running.map(|run| run.join().expect("no motion panics"))
    });
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/error-asked-for.md");
    std::fs::write(&path, page::text(&collections, MOTIONS, COMPARED))
        .with_context(|| format!("{} cannot be written", path.display()))
}
