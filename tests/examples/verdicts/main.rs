//! The study of verdicts: prints its tables, and fails if a step violates its equations.
//!
//! ```text
//! cargo run --release -p dalembert-tests --example verdicts [draws per system] [seed]
//! ```

mod study;
mod table;

use std::process::ExitCode;

use study::steps::{Job, study, study_all};
use study::systems::*;
use table::{table, violations};

/// Every system, each with Gauss rules of two numbers of stages.
const JOBS: [Job; 22] = [
    study::<Harmonic, 1, 1, 4>,
    study::<Chain, 4, 2, 5>,
    study::<Quartic, 1, 3, 6>,
    study::<Ring, 2, 1, 7>,
    study::<Pendulum, 1, 2, 8>,
    study::<DoublePendulum, 2, 3, 4>,
    study::<LennardJones, 1, 1, 8>,
    study::<Atoms, 3, 2, 6>,
    study::<Exponential, 1, 1, 5>,
    study::<Toda, 3, 2, 4>,
    study::<Morse, 1, 3, 7>,
    study::<MorseDry, 2, 2, 5>,
    study::<Kepler, 2, 1, 6>,
    study::<KeplerDrag, 3, 3, 4>,
    study::<Stiff, 2, 2, 8>,
    study::<Fermi, 4, 1, 3>,
    study::<Polar, 2, 2, 7>,
    study::<Shot, 2, 1, 4>,
    study::<Blocks, 4, 2, 3>,
    study::<Barrier, 1, 3, 8>,
    study::<Saturating, 1, 2, 5>,
    study::<Steep, 1, 1, 6>,
];

fn main() -> ExitCode {
    let arguments: Vec<u64> = std::env::args().skip(1).filter_map(|text| text.parse().ok()).collect();
    let draws = arguments.first().copied().unwrap_or(25_000) as u32;
    let rows = study_all(&JOBS, draws, arguments.get(1).copied().unwrap_or(1));
    print!("{}", table(&rows));
    if violations(&rows) == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
