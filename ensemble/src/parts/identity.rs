//! The study that a folder is of: a file with its columns, no rows, and what tells it from others as
//! metadata, put down by whoever is first, and never changed.

use std::path::Path;

use super::draft::{self, Draft, Put};
use super::error::PartsError;
use super::metadata::Entries;
use super::names::STUDY;
use super::table::Table;
use super::{encoding, found};

/// Puts down that `folder` is of the study `described`, with the columns of a table that has no rows.
///
/// Fails where it is another's.
pub(super) fn put_down(folder: &Path, empty: &Table, described: &Entries) -> Result<(), PartsError> {
    let path = folder.join(STUDY);
    let io = |source| PartsError::Io { path: path.clone(), source };
    for _ in 0..draft::TRIES {
        if path.try_exists().map_err(io)? {
            return found::open(&path, described).map(drop);
        }
        let mut draft = Draft::of(&path).map_err(io)?;
        encoding::write(&mut draft.file, &path, empty, described)?;
        if draft.put()? == Put::Placed {
            return Ok(());
        }
    }
    Err(io(draft::removed()))
}
