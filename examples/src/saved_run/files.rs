//! The files of a run, held against each other.

use std::fmt;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result, anyhow, bail, ensure};
use dalembert::Checkpoint;
use serde::{Deserialize, Serialize};

use crate::results;

/// The name of the file of rows.
pub const ROWS: &str = "rows.csv";
const CHECKPOINT: &str = "checkpoint.json";

/// What `checkpoint.json` holds.
#[derive(Serialize, Deserialize)]
pub struct Saved<const N: usize> {
    /// Which run this is.
    pub identity: String,
    /// Where it stands.
    pub run: Checkpoint<f64, N>,
    /// Length of `rows.csv`, in bytes.
    rows: u64,
    /// Digest of those bytes.
    rows_digest: String,
    /// Digest of all the entries above.
    check: String,
}

impl<const N: usize> Saved<N> {
    fn new(identity: String, run: Checkpoint<f64, N>, rows: u64, rows_digest: String) -> Result<Self> {
        let mut check = Digest::default();
        check.add(serde_json::to_string(&(&identity, &run, rows, &rows_digest))?.as_bytes());
        Ok(Self { identity, run, rows, rows_digest, check: check.to_string() })
    }
}

/// How often a lock is asked for, and how long after each time: a process that this one has just begun has
/// its open files until it is the other program.
const TRIES: u32 = 20;
const BETWEEN: Duration = Duration::from_millis(10);

fn locked(file: &File) -> std::result::Result<(), TryLockError> {
    for _ in 1..TRIES {
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => thread::sleep(BETWEEN),
            other => return other,
        }
    }
    file.try_lock()
}

/// The open files of a run that nobody else is running.
pub struct Files {
    folder: PathBuf,
    rows: File,
    /// Of the rows so far.
    digest: Digest,
    /// Length and digest of the rows at the checkpoint, and its steps.
    at_checkpoint: (u64, String),
    kept: Option<u64>,
}

impl Files {
    /// Opens the files in `folder`, and removes temporary ones that a killed run has left.
    pub fn open(folder: &Path) -> Result<Self> {
        let path = folder.join(ROWS);
        let opened = fs::create_dir_all(folder).and_then(|()| {
            OpenOptions::new().create(true).truncate(false).read(true).write(true).open(&path)
        });
        let rows = opened.map_err(|error| cannot_write(error, &path, "nothing was computed"))?;
        match locked(&rows) {
            Err(TryLockError::WouldBlock) => {
                bail!("another program is running the run in {}", folder.display())
            }
            // Where files cannot be locked, this is not known.
            Err(TryLockError::Error(_)) => {}
            Ok(()) => remove_temporaries(folder),
        }
        let at_checkpoint = (0, Digest::default().to_string());
        Ok(Self { folder: folder.to_owned(), rows, digest: Digest::default(), at_checkpoint, kept: None })
    }

    /// What the checkpoint says, if there is one.
    pub fn saved<const N: usize>(&mut self) -> Result<Option<Saved<N>>> {
        let path = self.folder.join(CHECKPOINT);
        let text = match fs::read(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(error).with_context(|| format!("cannot read {}", path.display())),
        };
        let refused = || {
            format!(
                "{} is no checkpoint of this run, or broken; remove the folder to begin anew",
                path.display()
            )
        };
        let saved: Saved<N> = serde_json::from_slice(&text).with_context(refused)?;
        let again = Saved::new(saved.identity.clone(), saved.run, saved.rows, saved.rows_digest.clone())?;
        ensure!(saved.check == again.check, refused());
        self.at_checkpoint = (saved.rows, saved.rows_digest.clone());
        self.kept = Some(saved.run.steps);
        Ok(Some(saved))
    }

    /// Cuts the rows to what the checkpoint has seen, once they are known to be these.
    pub fn cut_to_checkpoint(&mut self) -> Result<()> {
        let path = self.folder.join(ROWS);
        let (length, digest) = self.at_checkpoint.clone();
        self.digest =
            digest_of(&mut self.rows, length).with_context(|| format!("cannot read {}", path.display()))?;
        ensure!(
            self.digest.bytes == length && self.digest.to_string() == digest,
            "{} does not have the rows that {CHECKPOINT} beside it has seen: it was changed, or is another run's; remove the folder to \
             begin anew",
            path.display()
        );
        let cut = self.rows.set_len(length).and_then(|()| self.rows.seek(SeekFrom::Start(length)));
        self.explained(cut.map(drop), ROWS)
    }

    /// Adds a row, in one piece: one that can be read is a whole one.
    pub fn append(&mut self, line: String) -> Result<()> {
        let written = self.rows.write_all(line.as_bytes());
        self.explained(written, ROWS)?;
        self.digest.add(line.as_bytes());
        Ok(())
    }

    /// Writes the checkpoint, once the rows are on the disk.
    pub fn save<const N: usize>(&mut self, identity: &str, run: Checkpoint<f64, N>) -> Result<()> {
        self.explained(self.rows.sync_data(), ROWS)?;
        self.require(fs::metadata(self.folder.join(ROWS)).map(|found| found.len() == self.digest.bytes))?;
        let saved = Saved::new(identity.to_owned(), run, self.digest.bytes, self.digest.to_string())?;
        let text = serde_json::to_string(&saved)?;
        self.explained(results::replace(&self.folder.join(CHECKPOINT), &text), CHECKPOINT)?;
        self.kept = Some(run.steps);
        Ok(())
    }

    /// The end: what stands under the name of the rows is what was written.
    pub fn finish(self) -> Result<()> {
        self.explained(self.rows.sync_data(), ROWS)?;
        let found = File::open(self.folder.join(ROWS)).and_then(|mut file| digest_of(&mut file, u64::MAX));
        self.require(found.map(|found| found == self.digest))
    }

    /// Refuses rows that others have changed under this program.
    fn require(&self, is_right: io::Result<bool>) -> Result<()> {
        let changed = || {
            format!(
                "{} was changed while the run went on; remove the folder to begin anew",
                self.folder.join(ROWS).display()
            )
        };
        ensure!(is_right.with_context(changed)?, changed());
        Ok(())
    }

    /// Up to where the run is kept.
    pub fn as_far_as(&self) -> String {
        match self.kept {
            Some(steps) => format!("the run is kept up to step {steps}, and goes on from there"),
            None => "there is no checkpoint yet, and the run will begin anew".to_owned(),
        }
    }

    fn explained<T>(&self, result: io::Result<T>, name: &str) -> Result<T> {
        result.map_err(|error| cannot_write(error, &self.folder.join(name), &self.as_far_as()))
    }
}

fn cannot_write(error: io::Error, path: &Path, as_far_as: &str) -> anyhow::Error {
    let what = format!("cannot write {}: {}; {as_far_as}", path.display(), results::advice(&error));
    anyhow!(error).context(what)
}

/// Removes what a killed program has left of checkpoints that it was writing. They do no harm if that fails.
fn remove_temporaries(folder: &Path) {
    let temporary = format!(".{CHECKPOINT}.");
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(&temporary)) {
        let _ = fs::remove_file(entry.path());
    }
}

/// The digest of the first `most` bytes, or of all.
fn digest_of(file: &mut File, most: u64) -> io::Result<Digest> {
    file.seek(SeekFrom::Start(0))?;
    let mut bytes = file.take(most);
    let (mut digest, mut piece) = (Digest::default(), vec![0; 1 << 16]);
    loop {
        match bytes.read(&mut piece)? {
            0 => return Ok(digest),
            length => digest.add(&piece[..length]),
        }
    }
}

/// Fowler, Noll and Vo's hash (FNV-1a, 64 bits): what is changed by accident has another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Digest {
    state: u64,
    bytes: u64,
}

impl Default for Digest {
    fn default() -> Self {
        Self { state: 0xcbf2_9ce4_8422_2325, bytes: 0 }
    }
}

impl Digest {
    /// Goes on with `bytes`.
    pub fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.state = (self.state ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
        self.bytes += bytes.len() as u64;
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From the table of the hash's authors.
    #[test]
    fn the_digest_is_fnv_1a() {
        for (text, digest) in
            [("", "cbf29ce484222325"), ("a", "af63dc4c8601ec8c"), ("foobar", "85944171f73967e8")]
        {
            let mut of = Digest::default();
            of.add(text.as_bytes());
            assert_eq!(of.to_string(), digest);
        }
    }
}
