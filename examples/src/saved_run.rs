//! A run that can be interrupted at any moment and goes on from where it was, bit by bit as if nothing had happened.
//!
//! Its folder holds `rows.csv`, one row each time it is looked at, and `checkpoint.json`, written after every few rows. Rows after the
//! checkpoint are computed again; a row that broke off is cut away.

use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Seek, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use dalembert::{Checkpoint, Discrete, State, Trajectory};
use serde::{Deserialize, Serialize};

use crate::results;

/// When a run looks at its state, saves it, and ends; in steps.
#[derive(Clone, Copy, Debug)]
pub struct Schedule {
    /// Steps to a row.
    pub row: u64,
    /// Rows to a checkpoint.
    pub rows_to_checkpoint: u64,
    /// Steps of the run.
    pub end: u64,
}

/// What `checkpoint.json` holds.
#[derive(Serialize, Deserialize)]
struct Saved<const N: usize> {
    run: Checkpoint<f64, N>,
    /// Length of `rows.csv`, in bytes.
    rows: u64,
}

/// The files of a run.
pub struct SavedRun {
    folder: PathBuf,
}

impl SavedRun {
    /// The run in `folder`, which need not exist yet.
    pub fn in_folder(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// The file of rows.
    pub fn rows(&self) -> PathBuf {
        self.folder.join("rows.csv")
    }

    fn checkpoint(&self) -> PathBuf {
        self.folder.join("checkpoint.json")
    }

    /// Runs to the end of the schedule, from the checkpoint if there is one. `row` writes what a row says of a time and a state.
    ///
    /// Every checkpoint makes the run forget what its rule remembers; since they come after fixed numbers of steps, neither how
    /// often nor when a run was interrupted shows in any bit.
    ///
    /// # Errors
    /// A file cannot be read or written, or a step fails. The files then hold the run as far as they say, and the next call goes on.
    pub fn run<L, R, const N: usize>(
        &self,
        (system, rule): (&L, R),
        (h, start): (f64, State<f64, N>),
        schedule: Schedule,
        row: impl Fn(f64, &State<f64, N>) -> String,
    ) -> Result<State<f64, N>>
    where
        L: Discrete<R, N, Scalar = f64>,
    {
        let new = Checkpoint::new(h, start);
        let Saved { run, rows: length } = self.saved()?.unwrap_or(Saved { run: new, rows: 0 });
        ensure!(run.step_size == h, "{} belongs to another run; remove it", self.checkpoint().display());
        let mut taken = run.steps;
        let mut rows = self.rows_of_length(length)?;
        let mut run = Trajectory::resume(system, rule, run);
        while taken < schedule.end {
            for _ in 0..schedule.rows_to_checkpoint {
                for step in run.by_ref().take(schedule.row as usize) {
                    step.with_context(|| format!("after {taken} steps; {}", self.as_far_as()))?;
                }
                taken += schedule.row;
                // In one piece: a row that can be read is a whole one.
                let line = row(run.time(), run.state()) + "\n";
                self.explained(rows.write_all(line.as_bytes()), &self.rows())?;
            }
            self.explained(rows.sync_data(), &self.rows())?;
            let length = self.explained(rows.stream_position(), &self.rows())?;
            let saved = serde_json::to_string(&Saved { run: run.checkpoint(), rows: length })?;
            results::save(&self.checkpoint(), &saved)?;
        }
        Ok(*run.state())
    }

    fn saved<const N: usize>(&self) -> Result<Option<Saved<N>>> {
        let path = self.checkpoint();
        match fs::read_to_string(&path) {
            Ok(text) => serde_json::from_str(&text)
                .map(Some)
                .with_context(|| format!("{} is no checkpoint of this run; remove it", path.display())),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error).with_context(|| format!("cannot read {}", path.display())),
        }
    }

    /// The file of rows, cut to what the checkpoint has seen.
    fn rows_of_length(&self, length: u64) -> Result<File> {
        let path = self.rows();
        let opened = fs::create_dir_all(&self.folder).and_then(|()| {
            let mut file = OpenOptions::new().create(true).truncate(false).write(true).open(&path)?;
            file.set_len(length)?;
            file.seek(std::io::SeekFrom::End(0))?;
            Ok(file)
        });
        self.explained(opened, &path)
    }

    fn as_far_as(&self) -> String {
        format!("the run is kept up to {}, and goes on from there", self.checkpoint().display())
    }

    fn explained<T>(&self, result: std::io::Result<T>, path: &Path) -> Result<T> {
        result.with_context(|| format!("cannot write {}: make room; {}", path.display(), self.as_far_as()))
    }
}
