//! Counts of runs, kept in files so that those of several draws add up.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context as _, Result};

/// Runs, refused ones among them, and steps of the others, by method.
#[derive(Default)]
pub struct Counts(pub BTreeMap<String, [u64; 3]>);

impl Counts {
    /// A run of so many steps, or a refused one.
    pub fn add(&mut self, method: &str, steps: Option<u64>) {
        let [runs, refused, all] = self.0.entry(method.to_owned()).or_default();
        *runs += 1;
        *refused += u64::from(steps.is_none());
        *all += steps.unwrap_or(0);
    }

    pub fn refused(&self) -> u64 {
        self.0.values().map(|[_, refused, _]| refused).sum()
    }

    /// `method runs refused steps`, a line each.
    pub fn text(&self) -> String {
        let mut text = String::new();
        for (method, [runs, refused, steps]) in &self.0 {
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
                let sums = counts.0.entry(method.to_owned()).or_default();
                for (sum, word) in sums.iter_mut().zip(words) {
                    *sum += word.parse::<u64>()?;
                }
            }
        }
        Ok(counts)
    }
}
