//! The parts that are in a folder.

use std::collections::HashSet;
use std::fs;
use std::ops::Range;
use std::path::Path;

use super::error::PartsError;
use super::names;

/// The parts that are in a folder at one time, by their members.
pub(super) struct Listing(HashSet<Range<u64>>);

impl Listing {
    /// The parts that are in `folder` now.
    pub(super) fn of(folder: &Path) -> Result<Self, PartsError> {
        let at = |source| PartsError::Io { path: folder.to_owned(), source };
        let mut parts = HashSet::new();
        for entry in fs::read_dir(folder).map_err(at)? {
            parts.extend(entry.map_err(at)?.file_name().to_str().and_then(names::members));
        }
        Ok(Self(parts))
    }

    /// Whether this part is there.
    pub(super) fn has(&self, part: &Range<u64>) -> bool {
        self.0.contains(part)
    }

    /// A part of members that are not among the `planned` ones, and that was not there `before`.
    pub(super) fn other(&self, planned: &[Range<u64>], before: Option<&Self>) -> Option<&Range<u64>> {
        let (first, last) = (planned.first()?, planned.last()?);
        let is_other = |there: &Range<u64>| there.end <= first.start || last.end <= there.start;
        let is_new = |there: &Range<u64>| before.is_none_or(|before| !before.has(there));
        self.0.iter().filter(|there| is_other(there) && is_new(there)).min_by_key(|there| there.start)
    }

    /// A part that is there and holds some of the members of `planned` parts, and others.
    pub(super) fn across(&self, planned: &[Range<u64>]) -> Option<&Range<u64>> {
        let (Some(first), Some(last)) = (planned.first(), planned.last()) else { return None };
        let planned: HashSet<&Range<u64>> = planned.iter().collect();
        let is_among = |there: &Range<u64>| there.start < last.end && first.start < there.end;
        self.0
            .iter()
            .filter(|there| is_among(there) && !planned.contains(there))
            .min_by_key(|there| there.start)
    }
}

/// Whether two parts have a member in common.
pub(super) fn have_common(one: &Range<u64>, other: &Range<u64>) -> bool {
    one.start < other.end && other.start < one.end
}
