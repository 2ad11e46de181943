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
    /// Runs, refused ones among them, and steps of the others, by method.
    pub runs: BTreeMap<String, [u64; 3]>,
}

impl Counts {
    /// A run of so many steps, or a refused one.
    pub fn add(&mut self, method: &str, steps: Option<u64>) {
        let [runs, refused, all] = self.runs.entry(method.to_owned()).or_default();
        *runs += 1;
        *refused += u64::from(steps.is_none());
        *all += steps.unwrap_or(0);
    }

    pub fn refused(&self) -> u64 {
        self.runs.values().map(|[_, refused, _]| refused).sum()
    }

    /// `systems count`, and `method runs refused steps`, a line each.
    pub fn text(&self) -> String {
        let mut text = format!("systems {}\n", self.systems);
        for (method, [runs, refused, steps]) in &self.runs {
            writeln!(text, "{method} {runs} {refused} {steps}").expect("a string takes all");
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
