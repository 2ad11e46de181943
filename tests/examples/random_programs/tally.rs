//! Counts of a run, kept in a file so that runs over ranges of seeds add up.

use std::collections::BTreeMap;
use std::path::Path;

use super::class::Class;
use super::syntax::Program;
use super::trial::Trial;

/// Counts by name.
#[derive(Clone, Debug, Default)]
pub struct Tally(BTreeMap<String, u64>);

impl Tally {
    pub fn add(&mut self, name: impl Into<String>, count: u64) {
        *self.0.entry(name.into()).or_default() += count;
    }

    pub fn count(&self, name: &str) -> u64 {
        self.0.get(name).copied().unwrap_or(0)
    }

    /// Names that begin with `prefix`, without it, most frequent first.
    pub fn under(&self, prefix: &str) -> Vec<(String, u64)> {
        let mut found: Vec<(String, u64)> = self
            .0
            .iter()
            .filter_map(|(name, count)| Some((name.strip_prefix(prefix)?.to_owned(), *count)))
            .collect();
        found.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        found
    }

    pub fn merge(&mut self, other: &Self) {
        for (name, count) in &other.0 {
            self.add(name, *count);
        }
    }

    /// What became of one program.
    pub fn take(&mut self, program: &Program, trial: &Trial) {
        let of_program = Class::ALL.iter().filter(|(class, _)| program.classes.contains(class));
        self.took(of_program.map(|(class, _)| class.name()), trial);
    }

    /// What became of a program with these constructs.
    pub fn took<'c>(&mut self, constructs: impl Iterator<Item = &'c str> + Clone, trial: &Trial) {
        if *trial == Trial::Discarded {
            return self.add("discarded", 1);
        }
        self.add("programs", 1);
        for construct in constructs.clone() {
            self.add(format!("written {construct}"), 1);
        }
        match trial {
            Trial::Discarded => {}
            Trial::Refused(reason) => {
                self.add("refused", 1);
                self.add(format!("reason {}", general(reason)), 1);
            }
            Trial::Unread(_) => self.add("unread", 1),
            Trial::Failed(_) => self.add("failed", 1),
            Trial::Agrees { compared, near_branch, too_large } => {
                self.add("agreed", 1);
                self.add("points compared", *compared as u64);
                self.add("points near a branch", *near_branch as u64);
                self.add("points too large", *too_large as u64);
                for construct in constructs {
                    self.add(format!("agreed {construct}"), 1);
                }
            }
        }
    }

    pub fn write(&self, path: &Path) -> std::io::Result<()> {
        let text: String = self.0.iter().map(|(name, count)| format!("{count}\t{name}\n")).collect();
        std::fs::write(path, text)
    }

    pub fn read(path: &Path) -> std::io::Result<Self> {
        let mut tally = Self::default();
        for line in std::fs::read_to_string(path)?.lines() {
            if let Some((count, name)) = line.split_once('\t') {
                tally.add(name, count.parse().unwrap_or(0));
            }
        }
        Ok(tally)
    }
}

/// A message without the names in it, and without what to do instead.
pub fn general(reason: &str) -> String {
    let reason = reason.trim_start_matches("derivatives cannot be written out: ");
    let reason = reason.split("; ").next().unwrap_or(reason);
    let mut general = String::new();
    for (index, part) in reason.split('`').enumerate() {
        general += if index % 2 == 0 { part } else { "`…`" };
    }
    // Numbers are as many as programs.
    let mut words = String::new();
    for word in general.split(' ') {
        let is_number = word.trim_start_matches('-').chars().all(|c| c.is_ascii_digit()) && word.len() > 1;
        words += if is_number { "…" } else { word };
        words.push(' ');
    }
    words.trim_end().to_owned()
}
