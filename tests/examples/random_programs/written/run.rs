//! Runs of programs as people write them.

use super::super::batch::Workshop;
use super::super::engine::features;
use super::super::members::Way;
use super::super::run::{folder, keep, summary, workspace};
use super::super::tally::Tally;
use super::super::trial::{self, Trial};
use super::{Written, judgement, program};

/// Programs of one crate.
const BATCH: u64 = 100;

/// Programs built by rustc, each beside its plain copy.
pub fn compiled(count: u64, seed: u64, engine: &str) -> Result<usize, String> {
    let workshop =
        Workshop::new(&folder()?.join(format!("batch-written-{engine}")), &workspace(), features(engine));
    let mut failures = 0;
    for start in (seed..seed + count).step_by(BATCH as usize) {
        let seeds = start..(start + BATCH).min(seed + count);
        let programs: Vec<Written> = seeds.clone().map(program).collect();
        let outcome = workshop.run(&programs, engine)?;
        let mut tally = Tally::default();
        for (index, program) in programs.iter().enumerate() {
            let trial = match outcome.errors.get(&index) {
                Some(error) if outcome.not_rust.contains(&index) => {
                    println!("seed {}: no Rust: {error}", program.seed);
                    Trial::Discarded
                }
                Some(error) => judgement::told(error),
                None if Way::named(engine).is_some() => {
                    trial::judged_in_lanes(program.seed, outcome.computed.get(&(index, 0)))
                }
                None => judgement::judged(program, |point| outcome.computed.get(&(index, point))),
            };
            if let Trial::Failed(words) = &trial {
                println!("seed {}: {words}", program.seed);
                failures += 1;
            }
            tally.took(program.manners.iter().map(|manner| manner.name()), &trial);
        }
        keep(&tally, &format!("written-{engine}"), start, seeds.end - start)?;
        summary(&tally);
    }
    Ok(failures)
}
