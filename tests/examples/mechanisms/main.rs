//! The study of mechanisms: points, rods and bars joined at random, each step held against a second program
//! in twice the precision; `docs/evidence/mechanisms.md`.
//!
//! ```text
//! cargo study mechanisms -- SHAPES FIRST RUNS   # so many shapes from seed FIRST on, so many runs of each
//! cargo study mechanisms -- show SEED           # the text of a shape
//! cargo study mechanisms -- page                # docs/evidence/mechanisms.md, from the counts of all runs
//! ```

#[path = "../random_programs/beside.rs"]
mod beside;
mod built;
mod counts;
mod page;
mod text;

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context as _, Result, bail};
use counts::Counts;
use text::Text;

/// Shapes that are compiled, run and counted at once.
const BATCH: usize = 10;

fn main() -> Result<ExitCode> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let workspace =
        Path::new(env!("CARGO_MANIFEST_DIR")).parent().context("the tests stand in a workspace")?;
    let folder = workspace.join("tests/examples/mechanisms/counts");
    match words[..] {
        ["show", seed] => println!("{}", Text::of(seed.parse()?).declared),
        ["page"] => println!("{}", page::write(workspace, &folder)?.display()),
        [shapes, first, runs] => {
            let (shapes, first, runs): (u64, u64, u64) = (shapes.parse()?, first.parse()?, runs.parse()?);
            let folder = folder.join("now");
            std::fs::create_dir_all(&folder)?;
            let mut is_sound = true;
            for batch in (first..first + shapes).step_by(BATCH) {
                let seeds = batch..(batch + BATCH as u64).min(first + shapes);
                let mut counts = Counts::default();
                for line in built::run(workspace, seeds, runs)?.lines() {
                    if counts.add(line)? {
                        println!("{line}");
                    }
                }
                std::fs::write(folder.join(format!("{batch}-{runs}.txt")), counts.text())?;
                is_sound &= counts.is_sound();
            }
            return Ok(if is_sound { ExitCode::SUCCESS } else { ExitCode::FAILURE });
        }
        _ => bail!("SHAPES FIRST RUNS, `show SEED`, or `page`: see the head of this file"),
    }
    Ok(ExitCode::SUCCESS)
}
