//! Results as Parquet files: one for each part of the members.
//!
//! A part is there whole or not at all: it is written beside its place and renamed. What is there is done, so
//! that the parts are the checkpoint: after a kill, a full disk or a lost machine the same call computes what
//! is missing, and at the end the files are the same bits.
//!
//! ```
//! use dalembert::{Midpoint, State, rayleigh_system};
//! use dalembert_ensemble::Ensemble;
//!
//! #[rayleigh_system]
//! fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
//!     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
//! }
//! let study = Ensemble::new(|number| {
//!     let system = Pendulum { r: 1e-4 * number as f64 };
//!     let start = State::from_velocity(&system, [0.0], [1.0])?;
//!     Ok((system, start))
//! })
//! .by(Midpoint, 0.1)
//! .steps(100);
//!
//! # let folder = std::env::temp_dir().join(format!("dalembert-parts-doctest-{}", std::process::id()));
//! let parts = study.parts(&folder).members_per_part(500).column("r", |pendulum| pendulum.r);
//! assert_eq!(parts.write(0..1000)?.written, 2);
//! // Another process, or the same after it was killed: what is there is done.
//! assert_eq!(parts.write(0..2000)?.found, 2);
//! # std::fs::remove_dir_all(&folder).unwrap();
//! # Ok::<(), dalembert_ensemble::parts::PartsError>(())
//! ```
//!
//! **Columns.** `member`; those of [`column`](Parts::column); `t`; `q0` …, `p0` …; `energy`, at the time of
//! the row; `error`, null where there is none. A member that fails has its last good state in its last row,
//! with the error; one without a start has nulls. **Metadata**: system, structure, method with step size and
//! records, version, and those of [`metadata`](Parts::metadata); a part with others is refused as another
//! study's.

mod error;
mod file;
mod table;

use std::fs;
use std::ops::Range;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::thread::{self, ScopedJoinHandle};

use dalembert::{Lagrangian, State, StepError};

use crate::progress::Progress;
use crate::stepping::Stepping;
use crate::study::{Outcome, Study};
pub use error::PartsError;
use table::{Column, Row, Table};

/// Members of a part unless said.
const MEMBERS_PER_PART: u64 = 1 << 16;

/// Where the parts of a study go, and what is in them: [`Study::parts`].
#[must_use = "nothing is written before `write`"]
pub struct Parts<'s, 'f, F, M, L: Lagrangian<N>, const N: usize> {
    study: &'s Study<'f, F, M, L, N>,
    folder: PathBuf,
    members: u64,
    columns: Vec<Column<'s, L>>,
    metadata: Vec<(String, String)>,
}

/// Counts of the parts written and found, and of the members that failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// Parts that were computed and written.
    pub written: u64,
    /// Parts that were there.
    pub found: u64,
    /// Members that failed, of parts written and found.
    pub failed: u64,
}

impl<'f, F, M, L, const N: usize> Study<'f, F, M, L, N>
where
    F: Fn(u64) -> Result<(L, State<L::Scalar, N>), StepError> + Sync,
    L: Lagrangian<N> + Send,
    M: Stepping<L, N>,
{
    /// The results as files in `folder`, which is made where there is none.
    pub fn parts(&self, folder: impl AsRef<Path>) -> Parts<'_, 'f, F, M, L, N> {
        Parts {
            study: self,
            folder: folder.as_ref().to_owned(),
            members: MEMBERS_PER_PART,
            columns: Vec::new(),
            metadata: Vec::new(),
        }
    }
}

impl<'s, F, M, L, const N: usize> Parts<'s, '_, F, M, L, N>
where
    F: Fn(u64) -> Result<(L, State<L::Scalar, N>), StepError> + Sync,
    L: Lagrangian<N> + Send,
    M: Stepping<L, N>,
{
    /// Part k holds the members from k × `members` on; 65 536 unless said, 0 counts as 1.
    ///
    /// Two parts are held in memory, each with all its rows: one is written while the next is computed.
    pub fn members_per_part(mut self, members: u64) -> Self {
        self.members = members.max(1);
        self
    }

    /// A column of what `value` says of a member's system: its fields.
    pub fn column(mut self, name: impl Into<String>, value: impl Fn(&L) -> f64 + Sync + 's) -> Self {
        self.columns.push((name.into(), Box::new(value)));
        self
    }

    /// Something else that tells this study from others, such as the seed, or what
    /// [`stop_when`](Study::stop_when) waits for: it stands in every part, and a part
    /// with another is refused.
    pub fn metadata(mut self, key: impl Into<String>, value: impl ToString) -> Self {
        self.metadata.push((key.into(), value.to_string()));
        self
    }

    /// Computes the parts of the members `numbers` that are not there, and writes them.
    ///
    /// The numbers start with a part; of several processes that write into one folder, each takes its own.
    /// Progress counts the members of the part that is computed.
    ///
    /// # Errors
    /// A [`PartsError`]. The parts written until then stay.
    pub fn write(&self, numbers: Range<u64>) -> Result<Written, PartsError> {
        if !numbers.start.is_multiple_of(self.members) {
            return Err(PartsError::Unaligned { start: numbers.start, members: self.members });
        }
        let at = |source| PartsError::Io { path: self.folder.clone(), source };
        fs::create_dir_all(&self.folder).map_err(at)?;
        let planned: Vec<Range<u64>> = self.planned(numbers).collect();
        file::require_apart(&self.folder, &planned)?;
        file::remove_leftovers(&self.folder, &planned);
        let metadata = self.described();
        let mut written = Written::default();
        // A part is written while the next is computed.
        thread::scope(|scope| {
            let mut writing: Option<ScopedJoinHandle<'_, Result<(), PartsError>>> = None;
            let compute_all = || {
                for part in planned {
                    let path = file::path(&self.folder, &part);
                    if path.try_exists().map_err(|source| PartsError::Io { path: path.clone(), source })? {
                        written.failed += file::failed_in(&path, &metadata)?;
                        written.found += 1;
                        continue;
                    }
                    let (table, failed) = self.computed(part).map_err(PartsError::Cancelled)?;
                    finished(writing.take())?;
                    written.failed += failed;
                    written.written += 1;
                    let metadata = &metadata;
                    writing = Some(scope.spawn(move || file::write(&path, &table, metadata)));
                }
                Ok(())
            };
            let computed = compute_all();
            finished(writing)?;
            computed
        })?;
        Ok(written)
    }

    /// The files that the members `numbers` are in, or will be.
    pub fn paths(&self, numbers: Range<u64>) -> impl Iterator<Item = PathBuf> {
        self.planned(numbers).map(|part| file::path(&self.folder, &part))
    }

    fn planned(&self, numbers: Range<u64>) -> impl Iterator<Item = Range<u64>> {
        let members = self.members;
        let firsts = numbers.clone().step_by(usize::try_from(members).unwrap_or(usize::MAX));
        firsts.map(move |first| first..numbers.end.min(first.saturating_add(members)))
    }

    /// The rows of one part, and how many of its members failed.
    fn computed(&self, part: Range<u64>) -> Result<(Table, u64), Progress> {
        let names: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
        let rows_of = |outcomes: Vec<Outcome<Vec<Row<N>>, L::Scalar, N>>| {
            let (mut table, mut failed) = (Table::new(&names, N), 0);
            for mut outcome in outcomes {
                if let Some(failure) = &outcome.failure {
                    failed += 1;
                    self.add_failure(&mut outcome.value, failure);
                }
                outcome.value.into_iter().for_each(|row| table.push(row));
            }
            (table, failed)
        };
        self.study
            .reduce_chunks(
                part,
                |_| Vec::new(),
                |rows, record| {
                    rows.push(Row::of(
                        record.number,
                        record.system,
                        &self.columns,
                        record.time,
                        &record.state,
                    ));
                },
                rows_of,
                (Table::new(&names, N), 0),
                |(table, failed), (more, more_failed)| {
                    table.append(more);
                    *failed += more_failed;
                },
            )
            .map_err(|cancelled| cancelled.progress)
    }

    /// The last row of a member that failed.
    fn add_failure(&self, rows: &mut Vec<Row<N>>, failure: &crate::Failure<L::Scalar, N>) {
        let error = Some(failure.error.to_string());
        let row = match (&failure.last, (self.study.members)(failure.number)) {
            (Some(last), Ok((system, _))) => {
                Row::of(failure.number, &system, &self.columns, last.time, &last.state)
            }
            _ => Row::without_start(failure.number),
        };
        // A record that is already there holds the last good state.
        if rows.last().is_some_and(|known| known.time == row.time) {
            rows.pop();
        }
        rows.push(Row { error, ..row });
    }

    /// The metadata that tell this study from others.
    fn described(&self) -> Vec<(String, String)> {
        let columns: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
        let own = [
            ("dalembert.version", env!("CARGO_PKG_VERSION").to_owned()),
            ("dalembert.system", core::any::type_name::<L>().to_owned()),
            ("dalembert.structure", format!("{:?}", L::STRUCTURE)),
            ("dalembert.method", self.study.stepping.description()),
            ("dalembert.stops_when_arrived", self.study.arrival.is_some().to_string()),
            ("dalembert.columns", columns.join(", ")),
        ];
        let own = own.map(|(key, value)| (key.to_owned(), value));
        own.into_iter().chain(self.metadata.iter().cloned()).collect()
    }
}

/// Waits until a part is there.
fn finished(writing: Option<ScopedJoinHandle<'_, Result<(), PartsError>>>) -> Result<(), PartsError> {
    writing.map_or(Ok(()), |writing| writing.join().unwrap_or_else(|panic| resume_unwind(panic)))
}
