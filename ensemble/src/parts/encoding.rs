//! The rows of a part, or none, as a Parquet file.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::error::PartsError;
use super::metadata::Entries;
use super::sealed;
use super::table::Table;

/// Writes the file `path` to `file`, sealed, and returns its digest.
pub(super) fn write(
    file: &mut File,
    path: &Path,
    table: &Table,
    metadata: &Entries,
) -> Result<String, PartsError> {
    let io = |source: io::Error| PartsError::Io { path: path.to_owned(), source };
    let mut writer = BufWriter::new(&mut *file);
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
    writer.into_inner().map_err(|error| io(error.into_error()))?;
    sealed::seal(file).map_err(io)
}

fn write_table(to: impl Write + Send, table: &Table, metadata: &Entries) -> Result<(), ParquetError> {
    let blank = (sealed::KEY.to_owned(), sealed::BLANK.to_owned());
    let metadata = metadata.iter().chain([&blank]);
    let metadata = metadata.map(|(key, value)| KeyValue::new(key.clone(), value.clone())).collect();
    let properties = WriterProperties::builder()
        .set_key_value_metadata(Some(metadata))
        // Results hardly repeat.
        .set_dictionary_enabled(false)
        .build();
    let mut file = SerializedFileWriter::new(to, Arc::new(schema(table)?), Arc::new(properties))?;
    if table.members.is_empty() {
        file.close()?;
        return Ok(());
    }
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
    if let Some(events) = &table.events
        && let Some(mut column) = group.next_column()?
    {
        let (values, present) = present(events);
        let values: Vec<i32> = values.copied().collect();
        column.typed::<Int32Type>().write_batch(&values, Some(&present), None)?;
        column.close()?;
    }
    if let Some(mut column) = group.next_column()? {
        let (values, present) = present(&table.errors);
        let values: Vec<ByteArray> = values.map(|error| ByteArray::from(error.as_str())).collect();
        column.typed::<ByteArrayType>().write_batch(&values, Some(&present), None)?;
        column.close()?;
    }
    group.close()?;
    file.close()?;
    Ok(())
}

/// The values that there are, and 1 or 0 for each row.
fn present<T>(rows: &[Option<T>]) -> (impl Iterator<Item = &T>, Vec<i16>) {
    (rows.iter().flatten(), rows.iter().map(|row| i16::from(row.is_some())).collect())
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
    if table.events.is_some() {
        let event = Type::primitive_type_builder("event", Physical::INT32)
            .with_repetition(Repetition::OPTIONAL)
            .build()?;
        columns.push(Arc::new(event));
    }
    let error = Type::primitive_type_builder("error", Physical::BYTE_ARRAY)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(Some(LogicalType::String))
        .build()?;
    columns.push(Arc::new(error));
    Type::group_type_builder("members").with_fields(columns).build()
}
