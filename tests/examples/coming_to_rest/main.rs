//! The study of motions that come to rest: damped systems drawn at random, each run to its end by every
//! method that can step it.
//!
//! ```text
//! cargo study coming_to_rest -- 300 1              # systems from seed 1 on, by every method, to T = 10⁴
//! cargo study coming_to_rest -- 20 1 some          # to T = 10³, each by four methods
//! cargo study coming_to_rest -- show 7             # the program of a system
//! ```

#[path = "../random_programs/beside.rs"]
mod beside;
mod built;
mod methods;
mod system;

use std::process::ExitCode;

use anyhow::{Result, bail};
use system::System;

fn main() -> Result<ExitCode> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let refused = match words[..] {
        ["show", seed] => {
            let system = System::of(seed.parse()?);
            println!("{}", methods::module(&system, &methods::of_system(&system, usize::MAX), 1e4));
            0
        }
        [count, seed] => built::run(count.parse()?, seed.parse()?, usize::MAX, 1e4)?,
        [count, seed, "some"] => built::run(count.parse()?, seed.parse()?, 4, 1e3)?,
        _ => bail!("write `<count> <seed>`, and `some` for some methods of each"),
    };
    Ok(if refused == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
