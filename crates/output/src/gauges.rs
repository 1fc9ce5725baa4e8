//! `gauges.csv`: one row for each time, written as it comes.

use crate::OutputError;
use crate::number::Shortest;
use corpuscle_model::GaugeColumn;
use corpuscle_scene::{read_bytes, read_text};
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Writes rows of gauge values. Each row reaches the file with the call that gives it.
#[derive(Debug)]
pub(crate) struct GaugeWriter {
    path: PathBuf,
    file: File,
    /// Length of the file up to its last whole row, bytes.
    length: u64,
    columns: usize,
    rows: usize,
}

impl GaugeWriter {
    /// A new file with its header.
    pub(crate) fn create(path: &Path, columns: &[GaugeColumn]) -> Result<Self, OutputError> {
        let file = File::create_new(path).map_err(OutputError::write(path))?;
        let mut writer = Self { path: path.to_owned(), file, length: 0, columns: columns.len(), rows: 0 };
        let header = std::iter::once("time_s".to_owned()).chain(columns.iter().map(GaugeColumn::header));
        writer.put(header)?;
        Ok(writer)
    }

    /// An existing file, cut back to its first `rows` rows. What a crash tore off is cut with the rest.
    pub(crate) fn resume(path: &Path, rows: usize) -> Result<Self, OutputError> {
        let table = GaugeTable::read(path)?;
        let text = read_bytes(path).map_err(OutputError::read(path))?;
        let mut ends = text.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at as u64 + 1);
        let length = ends.nth(rows).ok_or_else(|| {
            let found = table.rows.len();
            OutputError::content(path, format!("it has {found} rows where the checkpoint counted {rows}"))
        })?;
        let file = OpenOptions::new().append(true).open(path).map_err(OutputError::write(path))?;
        file.set_len(length).map_err(OutputError::write(path))?;
        Ok(Self { path: path.to_owned(), file, length, columns: table.columns.len(), rows })
    }

    /// Adds a row.
    pub(crate) fn append(&mut self, time: f64, values: &[f64]) -> Result<(), OutputError> {
        if values.len() != self.columns {
            return Err(OutputError::GaugeCount { expected: self.columns, found: values.len() });
        }
        self.put([time].iter().chain(values).map(|value| Shortest(*value).to_string()))?;
        self.rows += 1;
        Ok(())
    }

    /// Puts all rows on the disk.
    pub(crate) fn sync(&self) -> Result<(), OutputError> {
        self.file.sync_data().map_err(OutputError::write(&self.path))
    }

    /// Rows written so far.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    fn put(&mut self, fields: impl Iterator<Item = String>) -> Result<(), OutputError> {
        let written = line(fields).and_then(|line| {
            self.file.write_all(&line)?;
            Ok(line.len() as u64)
        });
        match written {
            Ok(length) => self.length += length,
            Err(source) => {
                // On a full disk a part of the row may have gone in. If it cannot be taken out either, the reader and
                // `resume` pass over it.
                let _ = self.file.set_len(self.length);
                return Err(OutputError::write(&self.path)(source));
            }
        }
        Ok(())
    }
}

fn line(fields: impl Iterator<Item = String>) -> io::Result<Vec<u8>> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(fields)?;
    writer.into_inner().map_err(|error| error.into_error())
}

/// The gauges of a run as a table.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GaugeTable {
    /// Headers of the columns after `time_s`: `P1.depth_m`.
    pub columns: Vec<String>,
    /// Time of each row, s.
    pub times: Vec<f64>,
    /// Values of each row, one for each column.
    pub rows: Vec<Vec<f64>>,
}

impl GaugeTable {
    /// Reads `gauges.csv`. A last line without its end, as a crash leaves it, is passed over.
    ///
    /// # Errors
    /// [`OutputError::Read`] or, with the line, [`OutputError::Content`].
    pub fn read(path: &Path) -> Result<Self, OutputError> {
        let text = read_text(path).map_err(OutputError::read(path))?;
        let whole = &text[..text.rfind('\n').map_or(0, |end| end + 1)];
        Self::parse(whole).map_err(|what| OutputError::content(path, what))
    }

    fn parse(text: &str) -> Result<Self, String> {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let header = reader.headers().map_err(|error| error.to_string())?;
        if header.get(0) != Some("time_s") {
            return Err("the first column of its header is not time_s".into());
        }
        let columns = header.iter().skip(1).map(str::to_owned).collect();
        let mut table = Self { columns, ..Self::default() };
        for record in reader.records() {
            let record = record.map_err(|error| error.to_string())?;
            let line = record.position().map_or(0, csv::Position::line);
            let number = |field: &str| field.parse().map_err(|_| format!("line {line}: `{field}` is not a number"));
            let mut values = record.iter().map(number).collect::<Result<Vec<f64>, String>>()?;
            table.times.push(values.remove(0));
            table.rows.push(values);
        }
        Ok(table)
    }

    /// The values of a column over time, by its header.
    pub fn column(&self, header: &str) -> Option<Vec<f64>> {
        let index = self.columns.iter().position(|column| column == header)?;
        Some(self.rows.iter().map(|row| row[index]).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::fs;

    fn columns() -> Vec<GaugeColumn> {
        let column = |gauge: &str, quantity, unit| GaugeColumn { gauge: gauge.into(), quantity, unit };
        vec![column("P1", "depth", "m"), column("Mill, \"old\"", "discharge", "m3_per_s")]
    }

    #[test]
    fn each_row_is_in_the_file_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gauges.csv");
        let mut writer = GaugeWriter::create(&path, &columns()).unwrap();
        writer.append(0.5, &[0.1, f64::NAN]).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(text, "time_s,P1.depth_m,\"Mill, \"\"old\"\".discharge_m3_per_s\"\n0.5,0.1,NaN\n");
        let table = GaugeTable::read(&path).unwrap();
        assert_eq!(table.columns[1], "Mill, \"old\".discharge_m3_per_s");
        assert_eq!(table.column("P1.depth_m"), Some(vec![0.1]));
        assert!(matches!(writer.append(1.0, &[1.0]), Err(OutputError::GaugeCount { expected: 2, found: 1 })));
    }

    #[test]
    fn resume_cuts_back_and_drops_a_torn_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gauges.csv");
        let mut writer = GaugeWriter::create(&path, &columns()).unwrap();
        for row in 0..4 {
            writer.append(row as f64, &[row as f64, 1.0]).unwrap();
        }
        let whole = fs::read(&path).unwrap();
        writer.file.write_all(b"4,0.123").unwrap();
        assert_eq!(GaugeTable::read(&path).unwrap().times, [0.0, 1.0, 2.0, 3.0]);
        let mut again = GaugeWriter::resume(&path, 2).unwrap();
        assert_eq!(again.rows(), 2);
        for row in 2..4 {
            again.append(row as f64, &[row as f64, 1.0]).unwrap();
        }
        assert_eq!(fs::read(&path).unwrap(), whole);
        assert!(GaugeWriter::resume(&path, 9).unwrap_err().to_string().contains("4 rows"));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_disk_is_an_error_that_names_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gauges.csv");
        let mut writer = GaugeWriter::create(&path, &columns()).unwrap();
        writer.append(0.0, &[1.0, 2.0]).unwrap();
        let before = fs::read(&path).unwrap();
        writer.file = OpenOptions::new().write(true).open("/dev/full").unwrap();
        let text = writer.append(1.0, &[1.0, 2.0]).unwrap_err().to_string();
        assert!(text.contains("gauges.csv") && text.contains("free some space"), "{text}");
        assert_eq!(writer.rows(), 1);
        assert_eq!(fs::read(&path).unwrap(), before);
    }

    proptest! {
        #[test]
        fn values_read_back_to_the_same_bits(values in proptest::collection::vec(any::<f64>(), 2)) {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("gauges.csv");
            GaugeWriter::create(&path, &columns()).unwrap().append(values[0], &values).unwrap();
            let table = GaugeTable::read(&path).unwrap();
            for (back, value) in table.rows[0].iter().zip(&values) {
                prop_assert!(back.to_bits() == value.to_bits() || back.is_nan() && value.is_nan());
            }
        }
    }
}
