//! The study of motions that come to rest: damped systems drawn at random, each run to its end by every
//! method that can step it.
//!
//! ```text
//! cargo study coming_to_rest -- 40 1               # 40 texts from seed 1 on, by every method, to T = 10⁴
//! cargo study coming_to_rest -- 20 1 some          # to T = 10³, each by four methods
//! cargo study coming_to_rest -- 20 1 before ../old # the same by the runtime of another checkout
//! cargo study coming_to_rest -- show 7             # the program of a system
//! cargo study coming_to_rest -- page               # docs/evidence/coming-to-rest.md, from the counts
//! ```

#[path = "../random_programs/beside.rs"]
mod beside;
mod built;
mod counts;
mod methods;
mod page;
mod system;

use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context as _, Result, bail};
use built::Draw;
use system::System;

/// Systems of a text whose constants are fields, where all methods run them.
const MEMBERS: u64 = 12;

fn main() -> Result<ExitCode> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).parent().context("the tests stand in a workspace")?;
    let folder = own.join("tests/examples/coming_to_rest/counts");
    let (draw, runtime) = match words[..] {
        ["show", seed] => {
            let systems = System::all_of(seed.parse()?, MEMBERS);
            println!("{}", methods::module(&systems, &methods::of_system(&systems[0], usize::MAX), 1e4));
            return Ok(ExitCode::SUCCESS);
        }
        ["page"] => {
            println!("{}", page::write(own, &folder)?.display());
            return Ok(ExitCode::SUCCESS);
        }
        [count, seed] => {
            let (count, seed) = (count.parse()?, seed.parse()?);
            (Draw { count, seed, members: MEMBERS, most: usize::MAX, time: 1e4, workspace: own }, "all")
        }
        [count, seed, "some"] => {
            let (count, seed) = (count.parse()?, seed.parse()?);
            (Draw { count, seed, members: 1, most: 4, time: 1e3, workspace: own }, "now")
        }
        [count, seed, "before", other] => {
            let (count, seed) = (count.parse()?, seed.parse()?);
            (Draw { count, seed, members: 1, most: 4, time: 1e3, workspace: Path::new(other) }, "before")
        }
        _ => bail!("write `<count> <seed>`, and `some` for some methods of each"),
    };
    let counts = built::run(&draw)?;
    print!("{}", counts.text());
    std::fs::create_dir_all(folder.join(runtime))?;
    std::fs::write(folder.join(format!("{runtime}/{}-{}.txt", draw.seed, draw.count)), counts.text())?;
    Ok(if counts.refused() == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
