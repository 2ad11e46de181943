//! The long versions of the hard cases: writes `docs/hard-cases.md` and its pictures.
//!
//! ```text
//! cargo run --release -p dalembert-tests --example hard_cases [case…]
//! ```
//!
//! With names of cases it runs these, prints what they found and writes their pictures, but leaves the page as it is.

mod conservative;
mod frictional;
mod long;
mod page;

use anyhow::Result;
use page::Case;

/// Name on the command line, and what makes the case.
type Entry = (&'static str, fn() -> Result<Case>);

const CASES: [Entry; 13] = [
    ("kepler", conservative::kepler),
    ("kepler-drag", frictional::kepler_drag),
    ("double-pendulum", conservative::double_pendulum),
    ("spring-pendulum", conservative::spring_pendulum),
    ("henon-heiles", conservative::henon_heiles),
    ("fermi", conservative::fermi),
    ("singular-mass", conservative::singular_mass),
    ("magnetic", conservative::magnetic),
    ("overdamped", frictional::overdamped),
    ("stick-slip", frictional::stick_slip),
    ("fold", frictional::fold),
    ("rounding", long::rounding),
    ("angles", long::angles),
];

fn main() -> Result<()> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let mut cases = Vec::new();
    for (name, run) in CASES {
        if wanted.is_empty() || wanted.iter().any(|wanted| wanted == name) {
            let case = run()?;
            println!("{}", case.text(name));
            // Written at once: a run that breaks off loses no picture that it has made.
            case.draw(name)?;
            cases.push((name, case));
        }
    }
    if wanted.is_empty() {
        println!("{}", page::write(&cases)?.display());
    }
    Ok(())
}
