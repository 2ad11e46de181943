//! Counts of runs, kept in files so that those of several draws add up.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context as _, Result};

/// Counts of some draws.
#[derive(Default)]
pub struct Counts {
    /// Systems drawn.
    pub systems: u64,
    /// Runs, refused ones among them, steps of those that ended, and runs that left the range of h, by
    /// method.
    pub runs: BTreeMap<String, [u64; 4]>,
}

/// How a run ended.
pub enum End {
    /// At its time or at rest, after so many steps.
    After(u64),
    /// By an error of a step within the range of h.
    Refused,
    /// By an error where h is too long for the motion.
    OutsideTheRange,
}

impl Counts {
    /// A run, by how it ended.
    pub fn add(&mut self, method: &str, end: &End) {
        let [runs, refused, steps, outside] = self.runs.entry(method.to_owned()).or_default();
        *runs += 1;
        match end {
            End::After(taken) => *steps += taken,
            End::Refused => *refused += 1,
            End::OutsideTheRange => *outside += 1,
        }
    }

    pub fn refused(&self) -> u64 {
        self.runs.values().map(|[_, refused, ..]| refused).sum()
    }

    /// `systems count`, and `method runs refused steps outside`, a line each.
    pub fn text(&self) -> String {
        let mut text = format!("systems {}\n", self.systems);
        for (method, [runs, refused, steps, outside]) in &self.runs {
            writeln!(text, "{method} {runs} {refused} {steps} {outside}").expect("a string takes all");
        }
        text
    }

    /// The counts of all files of a folder.
    pub fn of_folder(folder: &Path) -> Result<Self> {
        let mut counts = Self::default();
        for file in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
            for line in std::fs::read_to_string(file?.path())?.lines() {
                let mut words = line.split(' ');
                let method = words.next().context("a method")?;
                if method == "systems" {
                    counts.systems += words.next().context("a count")?.parse::<u64>()?;
                    continue;
                }
                let sums = counts.runs.entry(method.to_owned()).or_default();
                for (sum, word) in sums.iter_mut().zip(words) {
                    *sum += word.parse::<u64>()?;
                }
            }
        }
        Ok(counts)
    }
}
