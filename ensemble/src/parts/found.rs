//! Files that are there: intact, of the study, and parts of the members of their name.

use std::collections::BTreeMap;
use std::fs::File;
use std::io;
use std::path::Path;

use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;

use super::error::PartsError;
use super::metadata::{Entries, MEMBERS, STARTS};
use super::sealed;

/// A part that is there.
pub(super) struct Found {
    /// Members that failed: each has one row with an error.
    pub(super) failed: u64,
    /// The digest of the file.
    pub(super) digest: String,
}

impl Found {
    /// The part in this file.
    ///
    /// Fails as [`open`] does.
    pub(super) fn at(path: &Path, metadata: &Entries) -> Result<Self, PartsError> {
        let (reader, digest) = open(path, metadata)?;
        let parquet = |source| PartsError::Parquet { path: path.to_owned(), source };
        Ok(Self { failed: errors_in(&reader).map_err(parquet)?, digest })
    }
}

/// A file that is there, and its digest.
///
/// Fails where its bytes are not those that were written, or where its metadata are not these.
pub(super) fn open(
    path: &Path,
    metadata: &Entries,
) -> Result<(SerializedFileReader<File>, String), PartsError> {
    let io = |source: io::Error| PartsError::Io { path: path.to_owned(), source };
    let mut file = File::open(path).map_err(io)?;
    let what = "its bytes are not those that were written";
    let digest = sealed::intact(&mut file).map_err(io)?;
    let digest = digest.ok_or_else(|| PartsError::Damaged { path: path.to_owned(), what })?;
    let parquet = |source| PartsError::Parquet { path: path.to_owned(), source };
    let reader = SerializedFileReader::new(file).map_err(parquet)?;
    let none = Vec::new();
    let there = reader.metadata().file_metadata().key_value_metadata().unwrap_or(&none);
    compare(path, there, metadata)?;
    Ok((reader, digest))
}

fn compare(path: &Path, there: &[KeyValue], here: &Entries) -> Result<(), PartsError> {
    let here: BTreeMap<&str, &str> = here.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
    let there: BTreeMap<&str, &str> = there
        .iter()
        .filter(|entry| entry.key != sealed::KEY)
        .filter_map(|entry| Some((entry.key.as_str(), entry.value.as_deref()?)))
        .collect();
    // The study before its members.
    let is_of_part = |key: &str| [MEMBERS, STARTS].contains(&key);
    let mut keys: Vec<&str> = here.keys().chain(there.keys()).copied().collect();
    keys.sort_by_key(|key| is_of_part(key));
    let Some(key) = keys.into_iter().find(|key| here.get(key) != there.get(key)) else { return Ok(()) };
    let path = path.to_owned();
    let [expected, found] = [&here, &there].map(|entries| entries.get(key).map(|&value| value.to_owned()));
    Err(match found {
        Some(members) if key == MEMBERS => PartsError::Misplaced { path, members },
        found => PartsError::AnotherStudy { path, key: key.to_owned(), expected, found },
    })
}

/// The rows of a part that have an error: as its last column, that of errors, is summed up in the file, or
/// counted where another program has left that out.
fn errors_in(part: &SerializedFileReader<File>) -> Result<u64, ParquetError> {
    let groups = part.metadata().row_groups();
    let summed_up = groups.iter().map(|group| {
        let nulls = group.columns().last()?.statistics()?.null_count_opt()?;
        u64::try_from(group.num_rows()).ok()?.checked_sub(nulls)
    });
    if let Some(errors) = summed_up.sum() {
        return Ok(errors);
    }
    let mut errors = 0;
    for row in part.get_row_iter(None)? {
        let row = row?;
        let last = row.get_column_iter().last();
        errors += u64::from(last.is_some_and(|(_, value)| *value != Field::Null));
    }
    Ok(errors)
}
