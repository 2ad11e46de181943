//! Counts of trials.

use std::collections::BTreeMap;
use std::fmt;

/// Trials of one fault.
#[derive(Debug, Default)]
pub struct Trials {
    tries: u32,
    left: Vec<String>,
    /// Trials with the fault made by hand, or without the check, and how many of them were seen to be faulty.
    control: [u32; 2],
    said: BTreeMap<String, u32>,
}

impl Trials {
    /// One more: what is wrong, if anything is.
    pub fn add(&mut self, left: Option<String>) {
        self.tries += 1;
        self.left.extend(left);
    }

    /// One more control, and whether the fault was seen.
    pub fn add_control(&mut self, is_seen: bool) {
        self.control[0] += 1;
        self.control[1] += u32::from(is_seen);
    }

    pub fn tries(&self) -> u32 {
        self.tries
    }

    /// What a call has said.
    pub fn hear(&mut self, said: &str) {
        *self.said.entry(said.to_owned()).or_default() += 1;
    }

    pub fn require_none_left(&self, fault: &str) {
        let [controls, seen] = self.control;
        assert!(self.tries > 0 && self.left.is_empty(), "{fault}: {self}, {:#?}", self.left);
        assert!(seen > 0, "{fault}: the control was seen {seen} times of {controls}");
    }
}

impl fmt::Display for Trials {
    /// Columns of the table.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { tries, left, control: [controls, seen], said } = self;
        let said: Vec<_> = said.iter().map(|(said, times)| format!("{said} {times}")).collect();
        write!(f, "{tries} | {} | {seen} of {controls} | {}", left.len(), said.join(", "))
    }
}
