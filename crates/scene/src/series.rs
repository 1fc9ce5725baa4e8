//! Values over time.

use crate::{Inflow, SceneError};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// A value over time: a number, a table of `[time_s, value]` rows, or a CSV file with those two columns.
/// Between rows it is linear; before the first and after the last it stays as there. Two rows at the same time are
/// a jump.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "expected a number, rows of [time_s, value], or a file, as in { csv = \"hydrograph.csv\" }"
)]
pub enum Series {
    /// The same at all times.
    Constant(f64),
    /// Rows of time in s and value.
    Table(Vec<[f64; 2]>),
    /// A CSV file: rows of time in s and value, after any lines of headers.
    File {
        /// The file.
        csv: PathBuf,
        /// By what its values are multiplied.
        #[serde(default = "one", skip_serializing_if = "is_one")]
        factor: f64,
    },
}

fn one() -> f64 {
    1.0
}

fn is_one(factor: &f64) -> bool {
    *factor == 1.0
}

impl Series {
    /// The series with its file, if any, read; a relative path is taken from `folder`.
    ///
    /// # Errors
    /// [`SceneError::Series`] with file and line where the file is not such a table.
    pub fn load(&self, folder: &Path) -> Result<Table, SceneError> {
        match self {
            Self::Constant(value) => Ok(Table::constant(*value)),
            Self::Table(rows) => {
                let error = |(_, what)| SceneError::Series { file: "the scene".into(), line: None, what };
                check_rows(rows).map_err(error)?;
                Ok(Table { rows: rows.clone() })
            }
            Self::File { csv, factor } => {
                let file = folder.join(csv);
                let table = read_csv(&file)?.times(*factor);
                let error =
                    |(_, what)| SceneError::Series { file, line: None, what: format!("times {factor:e}: {what}") };
                check_rows(&table.rows).map_err(error)?;
                Ok(table)
            }
        }
    }
}

/// A series in memory: at least one row, times in s finite and in order, values finite.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<[f64; 2]>", into = "Vec<[f64; 2]>")]
pub struct Table {
    rows: Vec<[f64; 2]>,
}

impl TryFrom<Vec<[f64; 2]>> for Table {
    type Error = String;

    /// A table of rows of time, s, and value; says what is wrong with rows that are none.
    fn try_from(rows: Vec<[f64; 2]>) -> Result<Self, String> {
        check_rows(&rows).map_err(|(_, what)| what)?;
        Ok(Self { rows })
    }
}

impl From<Table> for Vec<[f64; 2]> {
    fn from(table: Table) -> Self {
        table.rows
    }
}

impl Table {
    /// The same value at all times, which must be finite.
    pub fn constant(value: f64) -> Self {
        Self { rows: vec![[0.0, value]] }
    }

    /// The same table with all values multiplied by a finite factor.
    pub fn times(mut self, factor: f64) -> Self {
        self.rows.iter_mut().for_each(|row| row[1] *= factor);
        self
    }

    /// The rows of time, s, and value.
    pub fn rows(&self) -> &[[f64; 2]] {
        &self.rows
    }

    /// The value at time `t`, s; at a jump the one after it.
    pub fn at(&self, t: f64) -> f64 {
        let after = self.rows.partition_point(|row| row[0] <= t);
        match (after.checked_sub(1).map(|before| self.rows[before]), self.rows.get(after)) {
            (Some(before), Some(&after)) => between(before, after, t),
            (Some(only), None) => only[1],
            (None, _) => self.rows[0][1],
        }
    }

    /// The exact integral from `t0` to `t1`, s times the value's unit; negative where `t1` is before `t0`.
    pub fn integral(&self, t0: f64, t1: f64) -> f64 {
        if t1 < t0 {
            return -self.integral(t1, t0);
        }
        let (first, last) = (self.rows[0], self.rows[self.rows.len() - 1]);
        let before = first[1] * (t1.min(first[0]) - t0).max(0.0);
        let after = last[1] * (t1 - t0.max(last[0])).max(0.0);
        let within = |pair: &[[f64; 2]]| {
            let (from, to) = (t0.max(pair[0][0]), t1.min(pair[1][0]));
            if from < to {
                0.5 * (between(pair[0], pair[1], from) + between(pair[0], pair[1], to)) * (to - from)
            } else {
                0.0
            }
        };
        before + self.rows.windows(2).map(within).sum::<f64>() + after
    }
}

impl Inflow {
    /// The discharge over time, m3/s, with its file, if any, read; a relative path is taken from `folder`.
    ///
    /// # Errors
    /// [`SceneError::Series`] where the file is no such table or a discharge is negative.
    pub fn load_discharge(&self, folder: &Path) -> Result<Table, SceneError> {
        let table = self.discharge_m3_per_s.load(folder)?;
        match table.rows.iter().find(|row| row[1] < 0.0) {
            None => Ok(table),
            Some([time, discharge]) => {
                let file = match &self.discharge_m3_per_s {
                    Series::File { csv, .. } => folder.join(csv),
                    _ => "the scene".into(),
                };
                let what = format!(
                    "the discharge of inflow `{}` at {time} s is {discharge} m3/s and must not be negative: water leaves \
                     over open edges",
                    self.name
                );
                Err(SceneError::Series { file, line: None, what })
            }
        }
    }
}

/// Linear between two rows at different times.
fn between(before: [f64; 2], after: [f64; 2], t: f64) -> f64 {
    let part = (t - before[0]) / (after[0] - before[0]);
    before[1] + part * (after[1] - before[1])
}

/// Times and values beyond this are refused: differences and products of larger ones may not be finite.
const LARGEST: f64 = 1e100;

/// Finds the first invalid row; returns its index and the reason.
pub(crate) fn check_rows(rows: &[[f64; 2]]) -> Result<(), (usize, String)> {
    if rows.is_empty() {
        return Err((0, "there are no rows; give at least one of [time_s, value]".into()));
    }
    for (index, [time, value]) in rows.iter().enumerate() {
        if !time.is_finite() || !value.is_finite() {
            return Err((index, format!("time {time} and value {value} must be finite numbers")));
        }
        if time.abs() > LARGEST || value.abs() > LARGEST {
            return Err((index, format!("time {time:e} and value {value:e} must be at most {LARGEST:e}")));
        }
        if index > 0 && rows[index - 1][0] > *time {
            let before = rows[index - 1][0];
            return Err((index, format!("time {time} s comes after {before} s; sort the rows by time")));
        }
    }
    Ok(())
}

fn read_csv(file: &Path) -> Result<Table, SceneError> {
    let error = |line, what| SceneError::Series { file: file.to_owned(), line, what };
    let text =
        crate::read_text(file).map_err(|source| error(None, format!("cannot read this time series: {source}")))?;
    let mut rows: Vec<[f64; 2]> = Vec::new();
    let mut lines = Vec::new();
    for (index, line) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let fields: Vec<&str> = line.split([',', ';', '\t']).map(str::trim).collect();
        if fields.iter().all(|field| field.is_empty()) || line.starts_with('#') {
            continue;
        }
        match numbers(&fields) {
            Some(row) => {
                rows.push(row);
                lines.push(index + 1);
            }
            // Names and units stand above the numbers; a line that begins with a digit is a row.
            None if rows.is_empty()
                && !fields[0].starts_with(|first: char| first.is_ascii_digit() || "+-.".contains(first)) => {}
            None => {
                let what = format!("`{}` must be two numbers, time in s and value, with a comma between", line.trim());
                return Err(error(Some(index + 1), what));
            }
        }
    }
    check_rows(&rows).map_err(|(row, what)| error(lines.get(row).copied(), what))?;
    Ok(Table { rows })
}

fn numbers(fields: &[&str]) -> Option<[f64; 2]> {
    match fields {
        [time, value] => Some([time.parse().ok()?, value.parse().ok()?]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn table(rows: &[[f64; 2]]) -> Table {
        Series::Table(rows.to_vec()).load(Path::new("")).unwrap()
    }

    fn load_csv(text: &str) -> Result<Table, SceneError> {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("q.csv"), text).unwrap();
        Series::File { csv: "q.csv".into(), factor: 1.0 }.load(folder.path())
    }

    #[test]
    fn linear_between_rows_and_level_outside() {
        let q = table(&[[10.0, 1.0], [20.0, 3.0]]);
        assert_eq!([q.at(0.0), q.at(10.0), q.at(15.0), q.at(20.0), q.at(99.0)], [1.0, 1.0, 2.0, 3.0, 3.0]);
        assert_eq!(q.integral(0.0, 10.0), 10.0);
        assert_eq!(q.integral(10.0, 20.0), 20.0);
        assert_eq!(q.integral(15.0, 30.0), 12.5 + 30.0);
        assert_eq!(q.integral(30.0, 15.0), -42.5);
        assert_eq!(table(&[[0.0, 4.0]]).integral(-1.0, 2.0), 12.0);
    }

    #[test]
    fn two_rows_at_one_time_are_a_jump() {
        let q = table(&[[0.0, 0.0], [10.0, 0.0], [10.0, 5.0], [20.0, 5.0]]);
        assert_eq!([q.at(9.999), q.at(10.0)], [0.0, 5.0]);
        assert_eq!(q.integral(0.0, 20.0), 50.0);
    }

    #[test]
    fn csv_may_start_with_names_units_and_a_byte_order_mark() {
        let q = load_csv("\u{feff}time_s,discharge_m3_per_s\r\nseconds,1200\r\n0,0\r\n300,6\r\n\r\n").unwrap();
        assert_eq!(q.rows(), [[0.0, 0.0], [300.0, 6.0]]);
        assert_eq!(load_csv("# peak flow\n0;1\n5;2\n").unwrap().rows(), [[0.0, 1.0], [5.0, 2.0]]);
    }

    /// Between two such values the difference would be infinite.
    #[test]
    fn values_too_large_to_be_subtracted_are_refused() {
        for rows in ["-1 1e308\n0 -1e308", "-1e308 1\n1e308 2"] {
            let error = load_csv(&rows.replace(' ', "\t")).unwrap_err().to_string();
            assert!(error.contains("1e100"), "{error}");
        }
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("q.csv"), "0,1e99\n").unwrap();
        let error = Series::File { csv: "q.csv".into(), factor: 1e300 }.load(folder.path()).unwrap_err().to_string();
        assert!(error.contains("q.csv") && error.contains("times 1e300"), "{error}");
    }

    #[test]
    fn csv_errors_name_file_and_line() {
        for (text, parts) in [
            ("t,q\n0,1\n5,x\n", ["q.csv:3", "`5,x`"]),
            ("t,q\n0,1,2\n", ["q.csv:2", "two numbers"]),
            ("t,q\n0,1\n5\n", ["q.csv:3", "two numbers"]),
            ("t,q\n5,1\n\n0,1\n", ["q.csv:4", "sort the rows"]),
            ("0,1\n1,nan\n", ["q.csv:2", "finite"]),
            ("t,q\n", ["q.csv", "no rows"]),
            ("0 s,50\n60,10\n", ["q.csv:1", "two numbers"]),
            ("t,q\n2024-05-01 00:00,3\n", ["q.csv:2", "two numbers"]),
            ("0 1\n60 2\n", ["q.csv:1", "with a comma between"]),
            ("", ["q.csv", "no rows"]),
        ] {
            let message = load_csv(text).unwrap_err().to_string();
            assert!(parts.iter().all(|part| message.contains(part)), "{text:?}: {message}");
        }
        let missing =
            Series::File { csv: "none.csv".into(), factor: 1.0 }.load(Path::new("/tmp")).unwrap_err().to_string();
        assert!(missing.contains("none.csv") && missing.contains("cannot read"), "{missing}");
    }

    #[test]
    fn a_negative_discharge_in_a_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("q.csv"), "0,1\n60,-2\n").unwrap();
        let inflow = Inflow {
            name: "river".into(),
            at: Some([0.0, 0.0]),
            line: None,
            discharge_m3_per_s: Series::File { csv: "q.csv".into(), factor: 1.0 },
            velocity_m_per_s: [0.0, 0.0],
        };
        let message = inflow.load_discharge(folder.path()).unwrap_err().to_string();
        assert!(message.contains("q.csv: ") && message.contains("`river` at 60 s is -2 m3/s"), "{message}");
    }

    proptest! {
        #[test]
        fn any_bytes_make_a_table_or_an_error(text in "[0-9a-z.,;\\-\n ]{0,80}") {
            if let Ok(table) = load_csv(&text) {
                prop_assert!(!table.rows().is_empty());
                prop_assert!(table.at(1.0).is_finite());
            }
        }

        #[test]
        fn integral_is_additive_and_matches_the_midpoint_rule(
            mut times in prop::collection::vec(-50.0..50.0f64, 1..8),
            values in prop::collection::vec(-3.0..3.0f64, 8),
            t0 in -60.0..60.0f64, t1 in -60.0..60.0f64, t2 in -60.0..60.0f64,
        ) {
            times.sort_by(f64::total_cmp);
            let q = table(&times.iter().zip(&values).map(|(t, v)| [*t, *v]).collect::<Vec<_>>());
            let (whole, parts) = (q.integral(t0, t2), q.integral(t0, t1) + q.integral(t1, t2));
            prop_assert!((whole - parts).abs() < 1e-9);
            let n = 20_000;
            let step = (t1 - t0) / n as f64;
            let sum: f64 = (0..n).map(|i| q.at(t0 + (i as f64 + 0.5) * step) * step).sum();
            prop_assert!((sum - q.integral(t0, t1)).abs() < 0.05, "{sum} {}", q.integral(t0, t1));
        }
    }
}
