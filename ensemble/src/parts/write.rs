//! The call that writes what is missing: [`Parts::write`].

use std::fs;
use std::ops::Range;
use std::panic::resume_unwind;
use std::path::Path;
use std::thread::{self, ScopedJoinHandle};

use dalembert::system::ActingForce;
use dalembert::{Lagrangian, State, StepError};
use rayon::prelude::*;

use super::draft::{self, Draft, Put};
use super::error::PartsError;
use super::found::{self, Found};
use super::identity;
use super::listing::{Listing, have_common};
use super::metadata::Entries;
use super::table::Table;
use super::{Computed, Parts, Written, encoding, metadata, names, starts};
use crate::progress::Progress;
use crate::stepping::Stepping;
use crate::study::NO_START;

impl<F, M, L, const N: usize> Parts<'_, '_, F, M, L, N>
where
    F: Fn(u64) -> Result<(L, State<L::Scalar, N>), StepError> + Sync,
    L: ActingForce<N> + Send,
    M: Stepping<L, N>,
{
    /// Computes the parts of the members `numbers` that are not there, and writes them.
    ///
    /// The numbers start with a part. Several processes may write into one folder, best each its own range.
    /// Parts that are there are looked at first, so that nothing is computed where one is not of this study.
    /// Progress counts the members of all parts of the call, those that were there first.
    ///
    /// # Errors
    /// A [`PartsError`]. The parts written until then stay.
    pub fn write(&self, numbers: Range<u64>) -> Result<Written, PartsError> {
        if !numbers.start.is_multiple_of(self.members) {
            return Err(PartsError::Unaligned { start: numbers.start, members: self.members });
        }
        let described = self.described();
        let at = |source| PartsError::Io { path: self.folder.clone(), source };
        fs::create_dir_all(&self.folder).map_err(at)?;
        identity::put_down(&self.folder, &self.empty(), &described)?;
        let planned: Vec<Range<u64>> = self.planned(numbers.clone()).collect();
        let before = Listing::of(&self.folder)?;
        self.require_apart(&before, &planned)?;
        // There may be little room.
        self.sweep(&planned)?;
        self.require_one_study(&described, before.other(&planned, None))?;

        let members = numbers.end.saturating_sub(numbers.start);
        let mut call = Call {
            parts: self,
            described: &described,
            progress: Progress { done: 0, failed: 0, members },
            written: Written::default(),
            placed: Vec::new(),
        };
        let (there, missing): (Vec<_>, Vec<_>) = planned.iter().cloned().partition(|part| before.has(part));
        there.iter().try_for_each(|part| call.find(part))?;
        let computed = call.compute(missing);
        let Call { mut written, placed, .. } = call;
        computed?;
        written.spared = self.settled(&planned, &placed)?;
        // Or of another that has begun meanwhile.
        let there = Listing::of(&self.folder)?;
        self.require_one_study(&described, there.other(&planned, Some(&before)))?;
        Ok(written)
    }

    /// Fails where a part of other members is not of this study: they are made here, if they can be, and
    /// compared as those of a part that is found.
    fn require_one_study(&self, described: &Entries, other: Option<&Range<u64>>) -> Result<(), PartsError> {
        let is_known = |part: &&Range<u64>| {
            self.known.as_ref().is_none_or(|known| known.start <= part.start && part.end <= known.end)
        };
        let Some(other) = other.filter(is_known) else { return Ok(()) };
        let Some(starts) = self.starts(other, false) else { return Ok(()) };
        let path = names::path(&self.folder, other);
        match found::open(&path, &metadata::of_part(described, other, starts)) {
            Err(error @ PartsError::AnotherStudy { .. }) => Err(error),
            // What else is wrong with it is said by the call that it is of.
            _ => Ok(()),
        }
    }

    fn require_apart(&self, there: &Listing, planned: &[Range<u64>]) -> Result<(), PartsError> {
        there
            .across(planned)
            .map_or(Ok(()), |part| Err(PartsError::Overlap { path: names::path(&self.folder, part) }))
    }

    /// Removes what dead processes have left of these parts; how many files are spared.
    fn sweep(&self, planned: &[Range<u64>]) -> Result<u64, PartsError> {
        let (first, last) = (planned.first().map(|part| part.start), planned.last().map(|part| part.end));
        let is_ours = |name: &str| {
            names::members(name).is_none_or(|part| first <= Some(part.start) && Some(part.end) <= last)
        };
        let at = |source| PartsError::Io { path: self.folder.clone(), source };
        draft::sweep(&self.folder, is_ours).map_err(at)
    }

    /// Looks whether all parts are there, and none with some of their members beside them: a call to another
    /// end may have written one meanwhile. Then those that this call has `placed` go.
    fn settled(&self, planned: &[Range<u64>], placed: &[Range<u64>]) -> Result<u64, PartsError> {
        let there = Listing::of(&self.folder)?;
        if let Some(across) = there.across(planned) {
            for part in placed.iter().filter(|part| have_common(part, across)) {
                let path = names::path(&self.folder, part);
                fs::remove_file(&path).map_err(|source| PartsError::Io { path, source })?;
            }
        }
        self.require_apart(&there, planned)?;
        if let Some(gone) = planned.iter().find(|part| !there.has(part)) {
            return Err(PartsError::Gone { path: names::path(&self.folder, gone) });
        }
        self.sweep(planned)
    }

    /// The digest of all members of a part as they start, made anew; none where the call is cancelled, or
    /// where it `is_own` not and the function that makes members knows none of them.
    fn starts(&self, part: &Range<u64>, is_own: bool) -> Option<u128> {
        let start_of = |number: u64| {
            if self.study.is_flagged() {
                return None;
            }
            let start = match self.study.start(number) {
                Ok(start) => start,
                Err(_) if is_own => Err(NO_START),
                Err(_) => return None,
            };
            Some(self.start_of(part, number, &start))
        };
        let all: Option<Vec<u128>> = part.clone().into_par_iter().map(start_of).collect();
        all.map(|all| starts::of_all(&all))
    }
}

/// A call on its way.
struct Call<'c, 's, 'f, F, M, L: Lagrangian<N>, const N: usize> {
    parts: &'c Parts<'s, 'f, F, M, L, N>,
    described: &'c Entries,
    progress: Progress,
    written: Written,
    /// Parts that this call has put in their places.
    placed: Vec<Range<u64>>,
}

/// A part on its way to the disk, and how many of its members failed.
struct Writing<'w> {
    part: Range<u64>,
    failed: u64,
    put: ScopedJoinHandle<'w, Result<bool, PartsError>>,
}

impl<F, M, L, const N: usize> Call<'_, '_, '_, F, M, L, N>
where
    F: Fn(u64) -> Result<(L, State<L::Scalar, N>), StepError> + Sync,
    L: ActingForce<N> + Send,
    M: Stepping<L, N>,
{
    /// Looks at a part that is there.
    fn find(&mut self, part: &Range<u64>) -> Result<(), PartsError> {
        if self.parts.study.is_cancelled(self.progress) {
            return Err(PartsError::Cancelled(self.progress));
        }
        let path = names::path(&self.parts.folder, part);
        let starts = self.parts.starts(part, true).ok_or(PartsError::Cancelled(self.progress))?;
        let metadata = metadata::of_part(self.described, part, starts);
        let Found { failed, .. } = Found::at(&path, &metadata)?;
        self.count(part, failed);
        self.add_found(failed);
        // It is done, whether it is to end or not.
        self.parts.study.is_cancelled(self.progress);
        Ok(())
    }

    /// Computes the parts `missing`, and writes each while the next is computed.
    fn compute(&mut self, missing: Vec<Range<u64>>) -> Result<(), PartsError> {
        thread::scope(|scope| {
            let mut writing: Option<Writing<'_>> = None;
            let computed = missing.into_iter().try_for_each(|part| {
                let path = names::path(&self.parts.folder, &part);
                if path.try_exists().map_err(|source| PartsError::Io { path: path.clone(), source })? {
                    return self.find(&part);
                }
                let computed = self.parts.computed(&part, self.progress).map_err(PartsError::Cancelled)?;
                self.finish(writing.take())?;
                let Computed { table, failed, starts } = computed;
                self.count(&part, failed);
                let metadata = metadata::of_part(self.described, &part, starts::of_all(&starts));
                let put = scope.spawn(move || put(&path, &table, &metadata));
                writing = Some(Writing { part, failed, put });
                Ok(())
            });
            self.finish(writing)?;
            computed
        })
    }

    /// Waits until a part is there.
    fn finish(&mut self, writing: Option<Writing<'_>>) -> Result<(), PartsError> {
        let Some(Writing { part, failed, put }) = writing else { return Ok(()) };
        if put.join().unwrap_or_else(|panic| resume_unwind(panic))? {
            self.written.written += 1;
            self.written.failed += failed;
            self.placed.push(part);
        } else {
            self.add_found(failed);
        }
        Ok(())
    }

    fn count(&mut self, part: &Range<u64>, failed: u64) {
        self.progress.done += part.end - part.start;
        self.progress.failed += failed;
    }

    fn add_found(&mut self, failed: u64) {
        self.written.found += 1;
        self.written.failed += failed;
        self.written.failed_before += failed;
    }
}

/// Writes a part beside its place and puts it there; whether it was first.
///
/// Fails where another is there that is not equal.
fn put(path: &Path, table: &Table, metadata: &Entries) -> Result<bool, PartsError> {
    let io = |source| PartsError::Io { path: path.to_owned(), source };
    for _ in 0..draft::TRIES {
        let mut draft = Draft::of(path).map_err(io)?;
        let digest = encoding::write(&mut draft.file, path, table, metadata)?;
        match draft.put()? {
            Put::Placed => return Ok(true),
            Put::Taken => {
                let is_equal = Found::at(path, metadata)?.digest == digest;
                return if is_equal { Ok(false) } else { Err(PartsError::Unequal { path: path.to_owned() }) };
            }
            Put::Removed => {}
        }
    }
    Err(io(draft::removed()))
}
