//! The counts of the runs, one line for each seed, system and way, in `target/verdicts/`.

use std::fs;
use std::io::Write;
use std::path::PathBuf;

use anyhow::{Context, Result};

use crate::study::steps::{Row, Tally, WAYS};

fn path(name: &str) -> PathBuf {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).with_file_name("target");
    root.join("verdicts").join(format!("{name}.txt"))
}

/// What a line has to say.
pub struct Line {
    /// The seed.
    pub seed: u32,
    /// Name and number of coordinates of the system.
    pub system: String,
    /// Index of the way.
    pub way: usize,
    /// What was found.
    pub tally: Tally,
}

impl Line {
    fn written(&self) -> String {
        let Self { seed, system, way, tally } = self;
        let Tally { asked, taken, violations, worst, undecided, beyond, refused, within_reach } = tally;
        format!(
            "{seed};{system};{way};{asked};{taken};{violations};{worst:e};{undecided};{beyond};{refused};{within_reach}\n"
        )
    }

    fn read(line: &str) -> Option<Self> {
        let cells: Vec<&str> = line.split(';').collect();
        let [seed, system, way, asked, taken, violations, worst, undecided, beyond, refused, within_reach] =
            cells[..]
        else {
            return None;
        };
        let count = |cell: &str| cell.parse::<u64>().ok();
        let tally = Tally {
            asked: count(asked)?,
            taken: count(taken)?,
            violations: count(violations)?,
            worst: worst.parse().ok()?,
            undecided: count(undecided)?,
            beyond: count(beyond)?,
            refused: count(refused)?,
            within_reach: count(within_reach)?,
        };
        let way = way.parse().ok().filter(|way| *way < WAYS.len())?;
        Some(Self { seed: seed.parse().ok()?, system: system.to_owned(), way, tally })
    }
}

/// All lines of the runs under `name`; none if there was no run.
pub fn lines(name: &str) -> Result<Vec<Line>> {
    let path = path(name);
    if !path.exists() {
        return Ok(Vec::new());
    }
    let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    text.lines()
        .map(|line| Line::read(line).with_context(|| format!("{}: {line:?}", path.display())))
        .collect()
}

/// Whether there are counts with this seed.
pub fn has(name: &str, seed: u32) -> Result<bool> {
    Ok(lines(name)?.iter().any(|line| line.seed == seed))
}

/// Adds the counts of a seed.
pub fn add(name: &str, seed: u32, rows: &[Row]) -> Result<()> {
    let path = path(name);
    fs::create_dir_all(path.parent().context("a file in a folder")?)?;
    let mut text = String::new();
    for row in rows {
        for (way, tally) in row.tallies.iter().enumerate().filter(|(_, tally)| tally.asked > 0) {
            let system = format!("{}, n = {}", row.name, row.n);
            text += &Line { seed, system, way, tally: *tally }.written();
        }
    }
    let mut file = fs::OpenOptions::new().create(true).append(true).open(&path)?;
    // All of a seed, or with a full disk what does not read.
    file.write_all(text.as_bytes()).with_context(|| path.display().to_string())
}
