//! What came of the tolerances, over random motions: writes `docs/evidence/tolerance.md`.
//!
//! ```text
//! cargo study tolerance_study [seed motions [family]]
//! ```
//!
//! With a seed and a number of motions it prints every run of that collection, or family, instead.

mod page;

use std::env::args;
use std::path::Path;
use std::sync::Mutex;
use std::thread;

use anyhow::{Context, Result};
use dalembert_tests::motions::{Cheapest, Clock, Motion, Outcome, collection, driven, of_family};
use page::Collection;

/// The tolerances.
pub const TOLERANCES: [f64; 6] = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];

/// The collections: the code was written with an eye on the first two, not on the others.
const SEEDS: [u64; 4] = [1, 4711, 424_242, 8_675_309];

/// The collection of parametric drives and motions from rest: not looked at either.
const DRIVEN: u64 = 60_606;

/// Motions of each, and how many of them are compared to all fixed step sizes.
const MOTIONS: usize = 252;
const COMPARED: usize = 42;

/// A family of which there are more, with its seed and number: the one whose errors are hardest to tell.
const MORE: (&str, u64, usize) = ("stiff pair", 5, 500);

/// What came of one request.
pub struct Run {
    /// The kind of motion.
    pub family: &'static str,
    /// The tolerance.
    pub tolerance: f64,
    /// What came of the choice.
    pub chosen: Outcome,
    /// What came of the end that was asked for, and how many runs it took.
    pub reached: (Outcome, u32),
    /// The evaluations of the cheapest fixed choice, where that was looked for.
    pub cheapest: Option<f64>,
    /// The request by the clock beside that choice.
    pub clock: Option<Clock>,
}

/// Whoever measures time.
static CLOCK: Mutex<()> = Mutex::new(());

fn runs(motion: &Motion, is_compared: bool) -> Vec<Run> {
    let cheapest = if is_compared { motion.cheapest(&TOLERANCES) } else { vec![None; TOLERANCES.len()] };
    let each = TOLERANCES.into_iter().zip(cheapest);
    let run = |(tolerance, cheapest): (f64, Cheapest)| Run {
        family: motion.family,
        tolerance,
        chosen: motion.ask(tolerance),
        reached: motion.reach(tolerance),
        cheapest: cheapest.map(|cheapest| cheapest.0),
        clock: cheapest.and_then(|(_, method, steps)| {
            // One at a time: threads beside would be measured with it.
            let _alone = CLOCK.lock();
            motion.clock(tolerance, (method, steps))
        }),
    };
    each.map(run).collect()
}

fn main() -> Result<()> {
    let words: Vec<String> = args().skip(1).collect();
    if let [seed, count, family @ ..] = &words[..] {
        let (seed, count) = (seed.parse()?, count.parse()?);
        let motions =
            family.first().map_or_else(|| collection(seed, count), |name| of_family(name, seed, count));
        for motion in motions {
            for Run { family, tolerance, chosen, reached: (reached, runs), .. } in runs(&motion, false) {
                println!("{family}, {}: {tolerance:.0e}: {chosen:?}", motion.what);
                println!("    in {runs} runs: {reached:?}");
            }
        }
        return Ok(());
    }
    let of = |title: String, motions: &[Motion], compared: usize| {
        let all = motions.iter().enumerate();
        Collection { title, compared, runs: all.flat_map(|(i, motion)| runs(motion, i < compared)).collect() }
    };
    let of_seed = |seed: u64| of(format!("seed {seed}"), &collection(seed, MOTIONS), COMPARED);
    let (family, seed, count) = MORE;
    let later =
        || of(format!("seed {DRIVEN}, drives of L and falls from rest"), &driven(DRIVEN, MOTIONS), COMPARED);
    let more = || of(format!("seed {seed}, {family} alone"), &of_family(family, seed, count), 0);
    let collections = thread::scope(|scope| {
        let running = SEEDS.map(|seed| scope.spawn(move || of_seed(seed)));
        let mut all = Vec::from(running.map(|run| run.join().expect("no motion panics")));
        all.push(more());
        all.push(later());
        all
    });
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/evidence/tolerance.md");
    std::fs::write(&path, page::text(&collections))
        .with_context(|| format!("{} cannot be written", path.display()))
}
