//! The study of verdicts: random steps by every rule, each held against its equations in twice the precision;
//! `docs/evidence/verdicts.md`.
//!
//! ```text
//! cargo study verdicts -- NAME DRAWS FIRST LAST
//! cargo study verdicts -- page
//! ```
//!
//! The first takes so many draws of every system with each seed from FIRST to LAST, adds the counts of every
//! seed to `target/verdicts/NAME.txt`, from which a later run goes on, and fails if a step violates its
//! equations; the second writes the page from the counts under the name `now`.

mod counts;
mod page;
mod study;

use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use study::steps::{Job, Tally, study, study_all, study_by_dual, study_composed, study_fitted};
use study::systems::*;

/// Every system, each with a Gauss rule; a composition of some, the fitted rules of those that have them, and
/// some by dual numbers.
const JOBS: [Job; 45] = [
    study::<Harmonic, 1, 4>,
    study::<Springs, 1, 4>,
    study::<Magnets, 2, 3>,
    study::<Chain, 4, 5>,
    study::<Quartic, 1, 6>,
    study::<Ring, 2, 7>,
    study::<Pendulum, 1, 8>,
    study::<DoublePendulum, 2, 3>,
    study::<LennardJones, 1, 1>,
    study::<Atoms, 3, 2>,
    study::<Exponential, 1, 1>,
    study::<Toda, 3, 4>,
    study::<Morse, 1, 3>,
    study::<MorseDry, 2, 2>,
    study::<Kepler, 2, 6>,
    study::<KeplerDrag, 3, 3>,
    study::<Stiff, 2, 2>,
    study::<Fermi, 4, 1>,
    study::<Polar, 2, 7>,
    study::<Shot, 2, 4>,
    study::<Blocks, 4, 2>,
    study::<Barrier, 1, 8>,
    study::<Saturating, 1, 5>,
    study::<Steep, 1, 6>,
    study_composed::<DoublePendulum, 2>,
    study_composed::<LennardJones, 1>,
    study_composed::<KeplerDrag, 3>,
    study_composed::<Chain, 4>,
    study_fitted::<Harmonic, 1>,
    study_fitted::<Ring, 2>,
    study_fitted::<Pendulum, 1>,
    study_fitted::<LennardJones, 1>,
    study_fitted::<Exponential, 1>,
    study_fitted::<Toda, 3>,
    study_fitted::<Kepler, 2>,
    study_by_dual::<SpringsByDual, 1, 2>,
    study_by_dual::<MagnetsByDual, 2, 4>,
    study_by_dual::<ChainByDual, 4, 3>,
    study_by_dual::<RingByDual, 2, 4>,
    study_by_dual::<PendulumByDual, 1, 6>,
    study_by_dual::<DoublePendulumByDual, 2, 2>,
    study_by_dual::<LennardJonesByDual, 1, 3>,
    study_by_dual::<TodaByDual, 3, 2>,
    study_by_dual::<KeplerDragByDual, 3, 1>,
    study_by_dual::<PolarByDual, 2, 5>,
];

fn main() -> Result<ExitCode> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if arguments == ["page"] {
        println!("{}", page::write()?.display());
        return Ok(ExitCode::SUCCESS);
    }
    let [name, draws, first, last] = &arguments[..] else {
        anyhow::bail!("NAME DRAWS FIRST LAST, or `page`: see the head of this file");
    };
    let number = |text: &String| text.parse::<u32>().with_context(|| format!("{text:?} is no number"));
    let (draws, seeds) = (number(draws)?, number(first)?..=number(last)?);
    let mut violations = 0;
    for seed in seeds {
        ensure!(!counts::has(name, seed)?, "the counts of {name} have the seed {seed} already");
        let rows = study_all(&JOBS, draws, u64::from(seed));
        let mut sum = Tally::NONE;
        for row in &rows {
            sum = row.tallies.iter().fold(sum, |sum, of| sum.plus(*of));
            row.examples.iter().for_each(|example| println!("{} {example}", row.name));
        }
        println!("seed {seed}: {} asked, {} taken, {} violations", sum.asked, sum.taken, sum.violations);
        counts::add(name, seed, &rows)?;
        violations += sum.violations;
    }
    Ok(if violations == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
