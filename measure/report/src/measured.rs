//! All that was measured, and what is asked of it for pages and figures.

use crate::frontier::{Point, points, time_to_reach};
use crate::study::Record;
use crate::{long_run, section};

/// The scenes of the tables; the other chains are for the growth with n.
pub const SCENES: [&str; 8] = [
    "ring",
    "double pendulum",
    "FPUT chain",
    "Hénon–Heiles",
    "Kepler",
    "Kepler, e = 0.99",
    "Kepler, e = 0.999",
    "seven pendulums",
];

/// One of a run's errors.
pub type Error = fn(&Record) -> f64;

/// The errors that a table or figure can be about.
pub const QUANTITIES: [(&str, Error); 3] = [
    ("position", |record| record.position_error),
    ("momentum", |record| record.momentum_error),
    ("energy", |record| record.energy_error),
];

/// All that the page is made from.
pub struct Measured<'a> {
    pub records: &'a [Record],
    pub long: &'a [long_run::Record],
    pub samples: &'a [long_run::Sample],
    pub crossings: &'a [section::Record],
    pub ours: &'a [&'a str],
    /// What ran where, a line each.
    pub setting: &'a str,
    /// What lies behind the figures, written by hand; figures themselves stand in what is computed from the
    /// records.
    pub reading: &'a str,
}

/// Methods written in Rust are compared one trajectory at a time; this one integrates eight.
pub const BATCH: &str = "heyoka, batch of 8";

impl Measured<'_> {
    /// Methods in the order of the first scene they ran on.
    pub fn methods(&self) -> Vec<&str> {
        let mut methods: Vec<&str> = Vec::new();
        for record in self.records {
            if !methods.contains(&record.method.as_str()) {
                methods.push(&record.method);
            }
        }
        methods
    }

    pub fn is_ours(&self, method: &str) -> bool {
        self.ours.contains(&method)
    }

    pub fn time(&self, scene: &str, method: &str, error: f64, of: Error) -> Option<f64> {
        time_to_reach(error, points(self.records, scene, method, of))
    }

    /// The fastest of the methods that `which` lets through, at a position error.
    pub fn fastest(&self, scene: &str, error: f64, which: impl Fn(&str) -> bool) -> Option<(&str, f64)> {
        self.methods()
            .into_iter()
            .filter(|method| which(method))
            .filter_map(|method| Some((method, self.time(scene, method, error, QUANTITIES[0].1)?)))
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Fastest single-trajectory run whose energy stays within `error` up to the horizon of that index.
    pub fn fastest_long(
        &self,
        error: f64,
        horizon: usize,
        which: impl Fn(&str) -> bool,
    ) -> Option<(&str, f64)> {
        self.methods()
            .into_iter()
            .filter(|method| which(method))
            .filter_map(|method| {
                let runs = self.long.iter().filter(|record| record.method == method);
                let runs = runs.map(|run| Point { seconds: run.seconds, error: run.errors()[horizon] });
                Some((method, time_to_reach(error, runs)?))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }
}
