//! The long versions of the hard cases: writes `docs/hard-cases.md` and its pictures.
//!
//! ```text
//! cargo study hard_cases [text | case…]
//! ```
//!
//! With names of cases it runs these, prints what they found and draws their pictures in
//! `target/hard-cases/`: the page and its pictures are of one run. With `text` it runs none and writes the
//! page's text without figures anew.

mod conservative;
mod frictional;
#[cfg(test)]
mod held;
mod long;
mod page;
mod scaled_time;
mod text;

use anyhow::{Result, ensure};
use page::Case;

/// Name on the command line, and what makes the case.
type Entry = (&'static str, fn() -> Result<Case>);

const CASES: [Entry; 15] = [
    ("kepler", conservative::kepler),
    ("kepler-drag", frictional::kepler_drag),
    ("kepler-scaled", scaled_time::kepler),
    ("double-pendulum", conservative::double_pendulum),
    ("spring-pendulum", conservative::spring_pendulum),
    ("henon-heiles", conservative::henon_heiles),
    ("fermi", conservative::fermi),
    ("singular-mass", conservative::singular_mass),
    ("magnetic", conservative::magnetic),
    ("overdamped", frictional::overdamped),
    ("stick-slip", frictional::stick_slip),
    ("fold", frictional::fold),
    ("limit-cycle", frictional::limit_cycle),
    ("rounding", long::rounding),
    ("angles", long::angles),
];

fn main() -> Result<()> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    if wanted == ["text"] {
        println!("{}", page::write_text()?.display());
        return Ok(());
    }
    for name in &wanted {
        let names = CASES.map(|(name, _)| name).join(", ");
        ensure!(CASES.iter().any(|(case, _)| case == name), "there is no case {name:?}; there are {names}");
    }
    let mut cases = Vec::new();
    for (name, run) in CASES {
        if wanted.is_empty() || wanted.iter().any(|wanted| wanted == name) {
            let case = run()?;
            println!("{}", case.text(name));
            if !wanted.is_empty() {
                case.draw(name, &page::documents().with_file_name("target").join("hard-cases"))?;
            }
            cases.push((name, case));
        }
    }
    if wanted.is_empty() {
        println!("{}", page::write(&cases)?.display());
    }
    Ok(())
}
