//! Results as Parquet files: one for each part of the members.
//!
//! A part is there whole or not at all: it is written beside its place and then given its name. What is there
//! is done, so that the parts are the checkpoint: after a kill, a full disk or a lost machine the same call
//! computes what is missing, and at the end the files are the same bits.
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
//! **Columns.** `member`; those of [`column`](Parts::column) and
//! [`column_by_number`](Parts::column_by_number); `t`; `q0` …, `p0` …; `energy`, at the time of
//! the row; `event`, where the members are watched: the function that vanishes there, null of other rows;
//! `error`, null where there is none. A member that fails has its last good state in its last row, with the
//! error; one without a start has nulls.
//!
//! **A folder is of one study.** Its file `_study.parquet` says of which, as metadata: system, structure,
//! method with step size and records, members of a part, version, and [`metadata`](Parts::metadata). The
//! first call puts it down, and another study is refused, if it begins at the same moment too. It has the
//! columns of the parts and no rows, so that readers of a whole folder may read it or leave it out. A call
//! also looks at one part of other members, if there is one when it begins or another when it ends: another
//! study with the same metadata does not go on beside it ([`made_within`](Parts::made_within)).
//!
//! **A part is of its members.** Its metadata hold the same, its range, and a digest of its members' starts,
//! columns, and derivatives of L; of 64 members, evenly spread, also of the state after the first step, and
//! of the forces at 2 048 states in all, near and far
//! ([`sampled_forces`]): a model that was edited does not find the parts
//! of the one before. A call that finds a part makes its members anew, steps them no further, and compares. A
//! field that stands in no column, in R or f of members between those 64 alone, is not seen: say it by
//! [`identified_by`](Parts::identified_by). Nor is a closure of [`stop_when`](Study::stop_when): say by
//! `metadata` what it waits for. Bits are compared: a machine whose sine rounds otherwise does not go on with
//! the parts of another, nor beside them.
//!
//! **A part is what was written.** Its metadata hold a digest of all bytes of the file too, of 128 bits
//! (XXH3). A part that is found is read and compared once; of a flipped bit, a cut file, or a part under the
//! name of another a [`PartsError`] says which it is, and what to do.
//!
//! **Calls may run at once,** of one process or several, on one machine or several: parts of the same study
//! and other ranges, or the same ones. A part is put in its place by a link, which replaces nothing: who
//! comes second finds the first part, and compares it with its own. What a process has begun has a name of
//! its own, `.members-….parquet.PROCESS@HOST`, and is locked while the process lives. What a killed process
//! has left is removed by the next call for these members on the same host, or on any when the part is
//! there; else it is left alone, and counted ([`Written::spared`]). File systems without links (FAT) get a
//! rename that replaces nothing; where there is none either, [`PartsError::MayReplace`] says so.

mod draft;
mod encoding;
mod error;
mod found;
mod identity;
mod listing;
mod metadata;
mod names;
mod sealed;
mod starts;
mod table;
mod write;

use core::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use dalembert::nalgebra::SVector;
use dalembert::system::{ActingForce, sampled_forces};
use dalembert::{Lagrangian, State, StepError};

use crate::member::Record;
use crate::progress::Progress;
use crate::stepping::Stepping;
use crate::study::{Keeping, Outcome, Start, Study};
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
    own: Option<OwnDigest<'s>>,
    known: Option<Range<u64>>,
}

/// A digest of a member that the caller makes, of its number.
type OwnDigest<'s> = Box<dyn Fn(u64) -> u128 + Sync + 's>;

/// Counts of the parts written and found, and of the members that failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// Parts that were computed and written.
    pub written: u64,
    /// Parts that were there, or that another call has written meanwhile.
    pub found: u64,
    /// Members that failed, of parts written and found.
    pub failed: u64,
    /// Members among them of parts that were found.
    pub failed_before: u64,
    /// Files of parts of this call that another call writes, or may be writing on another host, left alone.
    pub spared: u64,
}

impl fmt::Display for Written {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { written, found, failed, failed_before, spared } = self;
        write!(f, "{written} parts written, {found} were there; {failed} members failed")?;
        if *failed_before > 0 {
            write!(f, ", {failed_before} of them in parts that were there")?;
        }
        if *spared > 0 {
            write!(f, "; {spared} files that another call may be writing were left alone")?;
        }
        Ok(())
    }
}

impl<'f, F, M, L, const N: usize> Study<'f, F, M, L, N>
where
    F: Fn(u64) -> Result<(L, State<L::Scalar, N>), StepError> + Sync,
    L: ActingForce<N> + Send,
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
            own: None,
            known: None,
        }
    }
}

impl<'s, F, M, L, const N: usize> Parts<'s, '_, F, M, L, N>
where
    F: Fn(u64) -> Result<(L, State<L::Scalar, N>), StepError> + Sync,
    L: ActingForce<N> + Send,
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
        self.columns.push((name.into(), Box::new(move |_, system| value(system))));
        self
    }

    /// A column of what `value` says of a member's number, where its system does not say it.
    pub fn column_by_number(
        mut self,
        name: impl Into<String>,
        value: impl Fn(u64) -> f64 + Sync + 's,
    ) -> Self {
        self.columns.push((name.into(), Box::new(move |number, _| value(number))));
        self
    }

    /// Something else that tells this study from others, such as the seed, or what
    /// [`stop_when`](Study::stop_when) waits for: it stands in every part, and a part
    /// with another is refused.
    pub fn metadata(mut self, key: impl Into<String>, value: impl ToString) -> Self {
        let key = key.into();
        self.metadata.retain(|(known, _)| *known != key);
        self.metadata.push((key, value.to_string()));
        self
    }

    /// A digest of each member, of its number, that tells it from that of another study where the start, the
    /// columns and the first step do not: of fields, say, that act later or on few members.
    pub fn identified_by(mut self, digest: impl Fn(u64) -> u128 + Sync + 's) -> Self {
        self.own = Some(Box::new(digest));
        self
    }

    /// The function that makes members knows no others than these, as where it has their starts in memory.
    /// Parts of others that are in the folder are not compared then.
    pub fn made_within(mut self, numbers: Range<u64>) -> Self {
        self.known = Some(numbers);
        self
    }

    /// The files that the members `numbers` are in, or will be.
    pub fn paths(&self, numbers: Range<u64>) -> impl Iterator<Item = PathBuf> {
        self.planned(numbers).map(|part| names::path(&self.folder, &part))
    }

    fn planned(&self, numbers: Range<u64>) -> impl Iterator<Item = Range<u64>> {
        let members = self.members;
        let firsts = numbers.clone().step_by(usize::try_from(members).unwrap_or(usize::MAX));
        firsts.map(move |first| first..numbers.end.min(first.saturating_add(members)))
    }

    /// A table of no rows.
    fn empty(&self) -> Table {
        let columns: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
        Table::new(&columns, N, self.study.stepping.has_events())
    }

    /// The rows of a part and more; `progress` is that before.
    fn computed(&self, part: &Range<u64>, progress: Progress) -> Result<Computed, Progress> {
        let empty = || Computed { table: self.empty(), failed: 0, starts: Vec::new() };
        let together = |outcomes: Vec<Outcome<Begun<N>, L::Scalar, N>>| {
            let mut all = empty();
            for Outcome { value: (mut rows, start), failure, .. } in outcomes {
                if let Some(failure) = &failure {
                    all.failed += 1;
                    self.add_failure(&mut rows, failure);
                }
                rows.into_iter().for_each(|row| all.table.push(row));
                all.starts.push(start);
            }
            all
        };
        let observe = |(rows, _): &mut Begun<N>, record: &Record<'_, L, N>| {
            let row = Row::of(record.number, record.system, &self.columns, record.time, &record.state);
            rows.push(Row { event: record.event, ..row });
        };
        self.study
            .reduce_chunks(
                part.clone(),
                progress,
                Keeping {
                    value: |number, start: &Start<L, N>| (Vec::new(), self.start_of(part, number, start)),
                    observe,
                    together,
                },
                empty(),
                |all, more| {
                    all.table.append(more.table);
                    all.failed += more.failed;
                    all.starts.extend(more.starts);
                },
            )
            .map_err(|cancelled| cancelled.progress)
    }

    /// The digest of a member of `part` as it starts.
    fn start_of(&self, part: &Range<u64>, number: u64, start: &Start<L, N>) -> u128 {
        let others = |system: &L, state: &State<L::Scalar, N>| {
            let mut numbers: Vec<f64> = self.columns.iter().map(|(_, value)| value(number, system)).collect();
            if let Some(states) = starts::sampled(part, number) {
                numbers.extend(self.study.stepping.at_start(system, state));
                let v = state.velocity(system).unwrap_or_else(|_| SVector::zeros());
                numbers.extend(sampled_forces(system, (&state.q, &v), number, states));
            }
            numbers
        };
        starts::of_member(start, others, self.own.as_ref().map(|own| own(number)))
    }

    /// The last row of a member that failed.
    fn add_failure(&self, rows: &mut Vec<Row<N>>, failure: &crate::Failure<L::Scalar, N>) {
        let error = Some(failure.error.to_string());
        let row = match (&failure.last, self.study.start(failure.number)) {
            (Some(last), Ok(Ok((system, _)))) => {
                Row::of(failure.number, &system, &self.columns, last.time, &last.state)
            }
            _ => Row::without_start(failure.number),
        };
        // A record that is already there holds the last good state.
        if rows.last().is_some_and(|known| known.time == row.time && known.event.is_none()) {
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
            ("dalembert.members_per_part", self.members.to_string()),
        ];
        let own = own.map(|(key, value)| (key.to_owned(), value));
        own.into_iter().chain(self.metadata.iter().cloned()).collect()
    }
}

/// The rows of a member, and its digest as it starts.
type Begun<const N: usize> = (Vec<Row<N>>, u128);

/// One part, computed.
struct Computed {
    table: Table,
    failed: u64,
    /// The digests of its members as they start.
    starts: Vec<u128>,
}
