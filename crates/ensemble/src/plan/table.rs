//! The table of a plan: a row for each member, a column for each key that is changed.

use crate::EnsembleError;
use serde_json::{Map, Value};
use std::path::Path;

/// A plan: keys of the scene, and for each member a value of each.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Dotted keys of the scene.
    pub columns: Vec<String>,
    /// Values of each member, in the order of the columns.
    pub rows: Vec<Vec<Value>>,
}

/// Heading of the column of members' numbers.
const MEMBER: &str = "member";

impl Plan {
    /// Reads a table in CSV. A first column `member` is passed over. A cell is a value as in JSON, or else text.
    ///
    /// # Errors
    /// [`EnsembleError::Plan`] with the line, for a table without rows or columns, one with two columns of a name, or a cell without a value.
    pub fn from_csv(text: &str, path: &Path) -> Result<Self, EnsembleError> {
        let wrong = |line: Option<usize>, what: String| EnsembleError::Plan { path: path.to_owned(), line, what };
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let header = reader.headers().map_err(|error| wrong(None, error.to_string()))?.clone();
        let first = usize::from(header.get(0) == Some(MEMBER));
        let columns: Vec<String> = header.iter().skip(first).map(str::to_owned).collect();
        for (number, key) in columns.iter().enumerate() {
            if key.trim().is_empty() || columns[..number].contains(key) {
                let what =
                    format!("the column `{key}` is there twice or has no name; each column is a key of the scene");
                return Err(wrong(Some(1), what));
            }
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|error| wrong(None, error.to_string()))?;
            let line = record.position().map(|position| position.line() as usize);
            if let Some(empty) = record.iter().skip(first).position(|cell| cell.trim().is_empty()) {
                let what = format!("{} has no value; fill it in, or leave the row out", columns[empty]);
                return Err(wrong(line, what));
            }
            rows.push(record.iter().skip(first).map(decoded).collect());
        }
        if rows.is_empty() || columns.is_empty() {
            let what = "the table needs a heading of keys, as flood.manning, and a row for each member";
            return Err(wrong(None, what.into()));
        }
        Ok(Self { columns, rows })
    }

    /// The table in CSV, with the members' numbers as first column.
    pub fn csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let header = std::iter::once(MEMBER).chain(self.columns.iter().map(String::as_str));
        let mut written = writer.write_record(header);
        for (number, row) in self.rows.iter().enumerate() {
            let cells = std::iter::once(number.to_string()).chain(row.iter().map(encoded));
            written = written.and_then(|()| writer.write_record(cells));
        }
        // Memory takes all that is written.
        written
            .ok()
            .and_then(|()| writer.into_inner().ok())
            .map_or_else(String::new, |text| String::from_utf8_lossy(&text).into_owned())
    }

    /// The changes of a member: values by key.
    pub fn changes(&self, member: usize) -> Map<String, Value> {
        self.columns.iter().cloned().zip(self.rows[member].iter().cloned()).collect()
    }

    /// The changes of a member as a scene takes them: keys, and values as written in TOML.
    pub fn assignments(&self, member: usize) -> Vec<(String, String)> {
        self.columns.iter().cloned().zip(self.rows[member].iter().map(written)).collect()
    }

    /// How `other`, which is given, differs from this plan, which is stored; none where it does not.
    pub(crate) fn difference(&self, other: &Self) -> Option<String> {
        if self.columns != other.columns {
            let [stored, given] = [self, other].map(|plan| plan.columns.join(", "));
            return Some(format!("the stored plan has the columns {stored}, the given one {given}"));
        }
        if self.rows.len() != other.rows.len() {
            let [stored, given] = [self, other].map(|plan| plan.rows.len());
            return Some(format!("the stored plan has {stored} members, the given one {given}"));
        }
        let cells = (0..self.rows.len()).flat_map(|row| (0..self.columns.len()).map(move |column| (row, column)));
        cells.map(|(row, column)| (row, column, &self.rows[row][column], &other.rows[row][column])).find_map(
            |(row, column, stored, given)| {
                let key = &self.columns[column];
                let [stored, given] = [stored, given].map(encoded);
                let differs = decoded(&stored) != decoded(&given);
                differs
                    .then(|| format!("{key} of member {row} is {stored} in the stored plan, {given} in the given one"))
            },
        )
    }
}

/// A value as a cell: as in JSON, but text without quotation marks unless it would read as another value.
pub(crate) fn encoded(value: &Value) -> String {
    match value {
        Value::String(text) if serde_json::from_str::<Value>(text).is_err() => text.clone(),
        value => value.to_string(),
    }
}

fn decoded(cell: &str) -> Value {
    serde_json::from_str(cell).unwrap_or_else(|_| Value::String(cell.into()))
}

/// A value as written in TOML.
fn written(value: &Value) -> String {
    match value {
        Value::String(text) => toml::Value::String(text.clone()).to_string(),
        Value::Array(items) => format!("[{}]", items.iter().map(written).collect::<Vec<_>>().join(", ")),
        value => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use serde_json::json;

    fn plan() -> Plan {
        let rows = vec![vec![json!(0.02), json!("a, \"b\"")], vec![json!(1e-7), json!("7")]];
        Plan { columns: vec!["flood.manning".into(), "title".into()], rows }
    }

    #[test]
    fn a_table_comes_back_from_csv_as_it_was() {
        let text = plan().csv();
        assert!(text.starts_with("member,flood.manning,title\n0,0.02,\"a, \"\"b\"\"\"\n"), "{text}");
        assert_eq!(Plan::from_csv(&text, Path::new("plan.csv")).unwrap(), plan());
    }

    #[test]
    fn values_are_written_as_toml_has_them() {
        assert_eq!(plan().assignments(1)[1], ("title".into(), "\"7\"".into()));
        assert_eq!(written(&json!([1, 2.5, true])), "[1, 2.5, true]");
    }

    #[test]
    fn a_difference_is_told_with_its_member() {
        let mut other = plan();
        assert_eq!(plan().difference(&other), None);
        other.rows[1][0] = json!(0.03);
        let told = plan().difference(&other).unwrap();
        assert!(told.contains("flood.manning of member 1 is 1e-7 in the stored plan, 0.03"), "{told}");
        other.rows.pop();
        assert!(plan().difference(&other).unwrap().contains("2 members, the given one 1"));
    }

    #[test]
    fn tables_that_are_wrong_are_refused_with_their_line() {
        let cases = [
            ("", "the table needs"),
            ("flood.manning\n", "the table needs"),
            ("a,a\n1,2\n", "there twice"),
            ("a,b\n1,2\n3,\n", "t.csv:3: b has no value"),
            ("a,b\n1\n", "t.csv"),
        ];
        for (text, told) in cases {
            let error = Plan::from_csv(text, Path::new("t.csv")).unwrap_err().to_string();
            assert!(error.contains(told), "{text:?}: {error}");
        }
    }

    proptest! {
        #[test]
        fn any_text_and_number_survives(text in "[^\r]*[a-z][^\r]*", number in proptest::num::f64::NORMAL) {
            prop_assume!(!text.trim().is_empty());
            let plan = Plan { columns: vec!["a".into(), "b".into()], rows: vec![vec![json!(text), json!(number)]] };
            prop_assert_eq!(Plan::from_csv(&plan.csv(), Path::new("p")).unwrap(), plan);
        }
    }
}
