//! Gauges as Parquet: one row for each time, one column of doubles for each gauge.

use crate::ExportError;
use crate::run::Run;
use corpuscle_atomic_file::WholeFile;
use corpuscle_output::GaugeTable;
use parquet::basic::{Compression, Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::io;
use std::path::Path;
use std::sync::Arc;

/// Writes the gauges of a run.
pub(crate) fn write(run: &Run, file: &Path) -> Result<(), ExportError> {
    let table = GaugeTable::read(&run.folder.join("gauges.csv"))?;
    if table.times.is_empty() {
        return Err(ExportError::NoGauges { path: run.folder.clone() });
    }
    let mut whole = WholeFile::create(file).map_err(ExportError::write(file))?;
    write_table(&table, run, &mut whole).map_err(|error| ExportError::write(file)(error_of(error)))?;
    whole.finish().map_err(ExportError::write(file))
}

/// The error of the system, if it is one.
fn error_of(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(source) => source.downcast().map_or_else(io::Error::other, |source| *source),
        error => io::Error::other(error),
    }
}

fn write_table(table: &GaugeTable, run: &Run, file: &mut WholeFile) -> Result<()> {
    let metadata = [("title", run.title()), ("source", run.source())];
    let metadata = metadata.map(|(key, value)| KeyValue::new(key.to_owned(), value));
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_dictionary_enabled(false)
        .set_key_value_metadata(Some(metadata.to_vec()))
        .build();
    let mut writer = SerializedFileWriter::new(file, schema(table)?, Arc::new(properties))?;
    let mut rows = writer.next_row_group()?;
    write_column(&mut rows, &table.times, None)?;
    for index in 0..table.columns.len() {
        let values = table.rows.iter().map(|row| row[index]);
        let numbers: Vec<f64> = values.clone().filter(|value| !value.is_nan()).collect();
        let is_number: Vec<i16> = values.map(|value| i16::from(!value.is_nan())).collect();
        write_column(&mut rows, &numbers, Some(&is_number))?;
    }
    rows.close()?;
    writer.close()?;
    Ok(())
}

/// The columns: the time always has a value; of a gauge one is missing where there was nothing to measure.
fn schema(table: &GaugeTable) -> Result<Arc<Type>> {
    let column = |name: &str, repetition| {
        let builder = Type::primitive_type_builder(name, Physical::DOUBLE);
        Ok(Arc::new(builder.with_repetition(repetition).build()?))
    };
    let gauges = table.columns.iter().map(|name| column(name, Repetition::OPTIONAL));
    let all: Result<Vec<_>> = std::iter::once(column("time_s", Repetition::REQUIRED)).chain(gauges).collect();
    Ok(Arc::new(Type::group_type_builder("gauges").with_fields(all?).build()?))
}

fn write_column(
    rows: &mut SerializedRowGroupWriter<'_, &mut WholeFile>,
    numbers: &[f64],
    is_number: Option<&[i16]>,
) -> Result<()> {
    let Some(mut column) = rows.next_column()? else {
        return Err(ParquetError::General("a column is not in the schema".into()));
    };
    column.typed::<DoubleType>().write_batch(numbers, is_number, None)?;
    column.close()
}
