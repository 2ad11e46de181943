//! Metadata of files: of a study, and of one part.

use std::ops::Range;

/// The key of the members of a part.
pub(super) const MEMBERS: &str = "dalembert.members";

/// The key of the digest of their starts.
pub(super) const STARTS: &str = "dalembert.starts";

/// Keys and values, in order.
pub(super) type Entries = [(String, String)];

/// The metadata of one part: those of its study, its members, and the digest of their starts.
pub(super) fn of_part(study: &Entries, part: &Range<u64>, starts: u128) -> Vec<(String, String)> {
    let own = [(MEMBERS, format!("{}..{}", part.start, part.end)), (STARTS, digits(starts))];
    study.iter().cloned().chain(own.map(|(key, value)| (key.to_owned(), value))).collect()
}

/// A digest as it is written.
pub(super) fn digits(digest: u128) -> String {
    format!("{digest:032x}")
}
