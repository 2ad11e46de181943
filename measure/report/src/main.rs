//! Speed against error: what a trajectory costs to given errors, by this project's methods and by others, in
//! one run.
//!
//! `cargo speed-against-error` measures and writes `docs/speed-against-error.md`; `… page` writes the page
//! again from the figures measured last, `… scenes` and `… long-run` measure one part again, `… scenes ring
//! Kepler` these scenes; `… section` the crossings of a section. `… ensembles`, of many trajectories, and `…
//! constraints`, of mechanisms, are pages of their own. Peers with a Python interface are run where the
//! interpreter that `PYTHON` names has them.

mod constraints;
mod ensembles;
mod figures;
mod frontier;
mod long_run;
mod measure;
mod measured;
mod ours;
mod page;
mod peers;
mod reference;
mod scenes;
mod section;
mod study;

use std::path::Path;
use std::{env, fs};

use anyhow::{Context, Result, bail};
use dalembert_examples::results;
use serde::Serialize;
use serde::de::DeserializeOwned;

use peers::python::Python;
use scenes::{
    DoublePendulum, EccentricKepler, FputChain2, FputChain4, FputChain8, FputChain16, FputChain32,
    HenonHeiles, Kepler, Pendulums, Ring,
};
use study::Record;

fn main() -> Result<()> {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let folder = docs.join("speed-against-error");
    match env::args().nth(1).as_deref() {
        None => {
            measure(&folder, Some(&[]), true)?;
            crossings(&folder)?;
        }
        Some("section") => crossings(&folder)?,
        Some("scenes") => measure(&folder, Some(&env::args().skip(2).collect::<Vec<_>>()), false)?,
        Some("long-run") => measure(&folder, None, true)?,
        Some("ensembles") => return ensembles::write(&docs),
        Some("constraints") => {
            return constraints::write(&docs, env::args().nth(2).as_deref() == Some("page"));
        }
        Some("page") => {}
        Some(other) => {
            bail!(
                "{other:?} is no part of the measurement: give `scenes`, `long-run` or `section` to measure these alone, `ensembles` for many trajectories, `constraints` for mechanisms, `page` to measure nothing, or \
                 no argument to measure all"
            )
        }
    }
    let records: Vec<Record> = read(&folder.join("scenes.csv"))?;
    let setting = fs::read_to_string(folder.join("setting.md"))?;
    let ours = scenes::names();
    let measured = measured::Measured {
        records: &records,
        long: &read(&folder.join("long-run.csv"))?,
        samples: &read(&folder.join("long-run-samples.csv"))?,
        crossings: &read(&folder.join("section.csv"))?,
        ours: &ours,
        setting: &setting,
        reading: include_str!("../reading.md"),
    };
    page::write(&docs, &measured)
}

/// Runs what is asked for, an empty list being all scenes, and writes what it measured.
fn measure(folder: &Path, wanted: Option<&[String]>, long: bool) -> Result<()> {
    let python = Python::start().inspect_err(|error| eprintln!("{error:#}")).ok();
    results::save(&folder.join("setting.md"), &page::setting(python.as_ref()))?;
    if let Some(wanted) = wanted {
        let path = folder.join("scenes.csv");
        // Of scenes not measured yet, or not again, what was measured last.
        let mut earlier: Vec<Record> = read(&path)?;
        let mut records = Vec::new();
        scenes(wanted, python.as_ref(), |name, measured| {
            records.extend(measured);
            earlier.retain(|record| record.scene != name);
            // Scene by scene: an interruption loses the one that it falls in.
            let all: Vec<&Record> = records.iter().chain(&earlier).collect();
            write(&path, &all)
        })?;
        if wanted.is_empty() {
            // None of scenes that are no more.
            write(&path, &records)?;
        }
    }
    if long {
        eprintln!("long run");
        let (records, samples) = long_run::measure(python.as_ref())?;
        write(&folder.join("long-run.csv"), &records)?;
        write(&folder.join("long-run-samples.csv"), &samples)?;
    }
    Ok(())
}

/// Measures the section.
fn crossings(folder: &Path) -> Result<()> {
    eprintln!("section");
    let python = Python::start().inspect_err(|error| eprintln!("{error:#}")).ok();
    write(&folder.join("section.csv"), &section::measure(python.as_ref())?)
}

/// The records of a file; none if there is no file, for a part not measured yet.
fn read<T: DeserializeOwned>(path: &Path) -> Result<Vec<T>> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let mut file = csv::Reader::from_path(path).with_context(|| path.display().to_string())?;
    Ok(file.deserialize().collect::<Result<_, _>>()?)
}

fn write<T: Serialize>(path: &Path, records: &[T]) -> Result<()> {
    let mut rows = csv::Writer::from_writer(Vec::new());
    for record in records {
        rows.serialize(record)?;
    }
    let rows = rows.into_inner().map_err(csv::IntoInnerError::into_error)?;
    results::save(path, std::str::from_utf8(&rows)?)
}

/// Measures the scenes wanted, or all, by the names that `references.txt` has, and hands the records of each
/// to `keep`.
fn scenes(
    wanted: &[String],
    python: Option<&Python>,
    mut keep: impl FnMut(&str, Vec<Record>) -> Result<()>,
) -> Result<()> {
    macro_rules! measure {
        ($($name:literal: $scene:expr, $n:literal;)*) => {$(
            if wanted.is_empty() || wanted.iter().any(|name| name == $name) {
                eprintln!("{}", $name);
                keep($name, study::scene::<_, $n, { 2 * $n }>($name, &$scene, python)?)?;
            }
        )*};
    }
    measure! {
        "ring": Ring::MEASURED, 2;
        "double pendulum": DoublePendulum::MEASURED, 2;
        "FPUT chain": FputChain8::MEASURED, 8;
        "Hénon–Heiles": HenonHeiles {}, 2;
        "Kepler": Kepler { k: 1e-4 }, 2;
        "Kepler, e = 0.99": EccentricKepler { k: 0.0 }, 2;
        "Kepler, e = 0.999": EccentricKepler { k: 1e-4 }, 2;
        "seven pendulums": Pendulums::EXAMPLE, 7;
        "FPUT chain, n = 2": FputChain2::MEASURED, 2;
        "FPUT chain, n = 4": FputChain4::MEASURED, 4;
        "FPUT chain, n = 8": FputChain8::MEASURED, 8;
        "FPUT chain, n = 16": FputChain16::MEASURED, 16;
        "FPUT chain, n = 32": FputChain32::MEASURED, 32;
    }
    Ok(())
}
