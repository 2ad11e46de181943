//! Parts as files: their names, there whole or not at all, and whose they are.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use atomic_write_file::AtomicWriteFile;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::Field;
use parquet::schema::types::Type;

use super::error::PartsError;
use super::table::Table;

const PREFIX: &str = "members-";
const SUFFIX: &str = ".parquet";

/// The file of the members `part`.
pub(super) fn path(folder: &Path, part: &Range<u64>) -> PathBuf {
    folder.join(format!("{PREFIX}{:012}-{:012}{SUFFIX}", part.start, part.end))
}

/// The members of a file by its name.
fn members(name: &str) -> Option<Range<u64>> {
    let (start, end) = name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX)?.split_once('-')?;
    Some(start.parse().ok()?..end.parse().ok()?)
}

/// Fails where a part that is there holds some of the members of `planned` parts, and others.
pub(super) fn require_apart(folder: &Path, planned: &[Range<u64>]) -> Result<(), PartsError> {
    let at = |source| PartsError::Io { path: folder.to_owned(), source };
    for entry in fs::read_dir(folder).map_err(at)? {
        let entry = entry.map_err(at)?;
        let Some(there) = entry.file_name().to_str().and_then(members) else { continue };
        let overlaps = |part: &Range<u64>| part.start < there.end && there.start < part.end;
        if planned.iter().any(|part| overlaps(part) && *part != there) {
            return Err(PartsError::Overlap { path: entry.path() });
        }
    }
    Ok(())
}

/// Removes what a process that was killed between writing one of these parts and renaming it has left. It
/// does no harm if that fails.
pub(super) fn remove_leftovers(folder: &Path, planned: &[Range<u64>]) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let hidden = name.to_str().and_then(|name| name.strip_prefix('.')?.rsplit_once('.'));
        let of_part = hidden.and_then(|(of_part, _)| members(of_part));
        if of_part.is_some_and(|part| planned.contains(&part)) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The members that failed of a part that is there: each has one row with an error.
///
/// Fails where the part is not one of the study with this metadata.
pub(super) fn failed_in(path: &Path, metadata: &[(String, String)]) -> Result<u64, PartsError> {
    let file = File::open(path).map_err(|source| PartsError::Io { path: path.to_owned(), source })?;
    let reader = SerializedFileReader::new(file)
        .map_err(|source| PartsError::Parquet { path: path.to_owned(), source })?;
    let none = Vec::new();
    let there = reader.metadata().file_metadata().key_value_metadata().unwrap_or(&none);
    for (key, expected) in metadata {
        let found = there.iter().find(|entry| entry.key == *key).and_then(|entry| entry.value.clone());
        if found.as_ref() != Some(expected) {
            let (path, key, expected) = (path.to_owned(), key.clone(), expected.clone());
            return Err(PartsError::AnotherStudy { path, key, expected, found });
        }
    }
    errors_in(&reader).map_err(|source| PartsError::Parquet { path: path.to_owned(), source })
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

/// Writes a part beside its place, and puts it there when all of it is on the disk.
pub(super) fn write(path: &Path, table: &Table, metadata: &[(String, String)]) -> Result<(), PartsError> {
    let io = |source: io::Error| PartsError::Io { path: path.to_owned(), source };
    let mut writer = BufWriter::new(AtomicWriteFile::open(path).map_err(io)?);
    write_table(&mut writer, table, metadata).map_err(|error| match error {
        // A full disk is one of the file system.
        ParquetError::External(source) => match source.downcast::<io::Error>() {
            Ok(source) => PartsError::Io { path: path.to_owned(), source: *source },
            Err(source) => {
                PartsError::Parquet { path: path.to_owned(), source: ParquetError::External(source) }
            }
        },
        source => PartsError::Parquet { path: path.to_owned(), source },
    })?;
    writer.into_inner().map_err(|error| io(error.into_error()))?.commit().map_err(io)
}

fn write_table(
    to: impl Write + Send,
    table: &Table,
    metadata: &[(String, String)],
) -> Result<(), ParquetError> {
    let metadata = metadata.iter().map(|(key, value)| KeyValue::new(key.clone(), value.clone())).collect();
    let properties = WriterProperties::builder()
        .set_key_value_metadata(Some(metadata))
        // Results hardly repeat.
        .set_dictionary_enabled(false)
        .build();
    let mut file = SerializedFileWriter::new(to, Arc::new(schema(table)?), Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    if let Some(mut column) = group.next_column()? {
        column.typed::<Int64Type>().write_batch(&table.members, None, None)?;
        column.close()?;
    }
    for numbers in &table.numbers {
        if let Some(mut column) = group.next_column()? {
            column.typed::<DoubleType>().write_batch(&numbers.values, Some(&numbers.present), None)?;
            column.close()?;
        }
    }
    if let Some(mut column) = group.next_column()? {
        let values: Vec<ByteArray> =
            table.errors.iter().flatten().map(|error| ByteArray::from(error.as_str())).collect();
        let present: Vec<i16> = table.errors.iter().map(|error| i16::from(error.is_some())).collect();
        column.typed::<ByteArrayType>().write_batch(&values, Some(&present), None)?;
        column.close()?;
    }
    group.close()?;
    file.close()?;
    Ok(())
}

fn schema(table: &Table) -> Result<Type, ParquetError> {
    let member = Type::primitive_type_builder("member", Physical::INT64)
        .with_repetition(Repetition::REQUIRED)
        .with_logical_type(Some(LogicalType::integer(64, false)))
        .build()?;
    let mut columns = vec![Arc::new(member)];
    for numbers in &table.numbers {
        let column = Type::primitive_type_builder(&numbers.name, Physical::DOUBLE)
            .with_repetition(Repetition::OPTIONAL)
            .build()?;
        columns.push(Arc::new(column));
    }
    let error = Type::primitive_type_builder("error", Physical::BYTE_ARRAY)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(Some(LogicalType::String))
        .build()?;
    columns.push(Arc::new(error));
    Type::group_type_builder("members").with_fields(columns).build()
}
