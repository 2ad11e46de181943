//! Mechanisms on constraints: this project's steps beside integrators of the equations without multipliers
//! and beside MuJoCo, over a short and a long time.

mod figure;
mod mechanisms;
mod page;
mod reduced;
mod runs;
mod systems;

use std::fs;
use std::path::Path;

use anyhow::{Result, ensure};
use dalembert_examples::results;
use serde::{Deserialize, Serialize};

use crate::peers::python::Python;

/// The name of the page, and of the folder of its figures and its picture.
const NAME: &str = "constraints-beside-others";

/// A time that motions take, and how they are looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Horizon {
    time: f64,
    /// In how many equal parts they are looked at.
    parts: usize,
    /// Seconds a unit of time after which a method's settings are not refined further.
    longest: f64,
}

const HORIZONS: [Horizon; 2] =
    [Horizon { time: 10.0, parts: 10, longest: 2e-3 }, Horizon { time: 1000.0, parts: 100, longest: 1e-3 }];

/// A measured run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Record {
    mechanism: String,
    /// The time of the motion.
    horizon: f64,
    method: String,
    /// Step size, or tolerance.
    setting: f64,
    /// The rate of Baumgarte's stabilisation, 1/s.
    alpha: f64,
    /// Processor time of a unit of time.
    seconds: f64,
    /// The largest distance off a constraint, m.
    off: f64,
    /// The largest error of the energy, J.
    energy_error: f64,
    /// The largest error of the vertical angular momentum, N m s, where it has a closed form.
    momentum_error: Option<f64>,
    /// The largest error of a coordinate at the end, m or rad.
    position_error: f64,
}

/// Measures, or takes what was measured last, and writes the page and its picture.
///
/// # Errors
/// A reference is missing, or a file cannot be read or written.
pub fn write(docs: &Path, is_measured: bool) -> Result<()> {
    let folder = docs.join("evidence").join(NAME);
    let [figures, picture, setting] = ["runs.csv", "errors.svg", "setting.md"].map(|file| folder.join(file));
    if !is_measured {
        let python = Python::start()?;
        results::save(&setting, &crate::page::setting(Some(&python)))?;
        let mut records = Vec::new();
        for horizon in HORIZONS {
            // One after the other: an interruption loses the one that it falls in.
            mechanisms::all(horizon, &python, &mut records, |records| crate::write(&figures, records))?;
        }
    }
    let records: Vec<Record> = crate::read(&figures)?;
    ensure!(!records.is_empty(), "{} is empty: measure first", figures.display());
    results::save(&picture, &figure::svg(&records)?)?;
    results::save(&folder.with_extension("md"), &page::text(&records, &fs::read_to_string(setting)?)?)
}
