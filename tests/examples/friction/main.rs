//! The study of dry friction that holds, `rule = proximal`: sliders drawn at random against their motion from
//! event to event, loads at the edge of what holds, each step's problem against all ways to stick and to
//! slide. Writes `docs/evidence/dry-friction.md`; some minutes of one core.
//!
//! ```text
//! cargo study friction                 # the page
//! cargo study friction -- 20 7000      # 20 sliders from seed 7000 on, and nothing written
//! ```

mod page;
mod rest;
mod steps;

use std::path::Path;

use anyhow::{Result, bail};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        [] => {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/evidence/dry-friction.md");
            std::fs::write(&path, page::text()?)?;
            println!("{}", path.display());
        }
        [count, first] => print!("{}", rest::tables(count.parse()?, first.parse()?)?),
        _ => bail!("a number of sliders and a first seed, or nothing"),
    }
    Ok(())
}
