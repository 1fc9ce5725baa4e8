//! Values of a scene by their keys.

use corpuscle_scene::Series;
use toml::{Table, Value};

/// Sets a value in a list of changes; none removes it.
pub fn set(changes: &mut Vec<(String, String)>, path: &str, value: Option<String>) {
    let at = changes.iter().position(|(changed, _)| changed == path);
    match (at, value) {
        (Some(at), Some(value)) => changes[at].1 = value,
        (Some(at), None) => {
            changes.remove(at);
        }
        (None, Some(value)) => changes.push((path.to_owned(), value)),
        (None, None) => {}
    }
}

/// A value as a number; none where it is none.
pub fn as_number(value: &Value) -> Option<f64> {
    match value {
        Value::Integer(number) => Some(*number as f64),
        Value::Float(number) => Some(*number),
        _ => None,
    }
}

/// The value at a path of `--set`: rows of lists are counted from 0.
pub fn value_at<'a>(document: &'a Table, path: &str) -> Option<&'a Value> {
    let mut words = path.split('.');
    let mut value = document.get(words.next()?)?;
    for word in words {
        value = match value {
            Value::Table(table) => table.get(word)?,
            Value::Array(rows) => rows.get(word.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    Some(value)
}

/// Inserts the tables down to a value that the document leaves out; none where it has the value, or cannot have it.
pub(super) fn slot_at<'a>(document: &'a mut Table, path: &str) -> Option<&'a mut Value> {
    if value_at(document, path).is_some() {
        return None;
    }
    let (holder, last) = path.rsplit_once('.')?;
    let mut words = holder.split('.');
    let mut value = document.entry(words.next()?).or_insert_with(|| Value::Table(Table::new()));
    for word in words {
        value = match value {
            Value::Table(table) => table.entry(word).or_insert_with(|| Value::Table(Table::new())),
            Value::Array(rows) => rows.get_mut(word.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    match value {
        Value::Table(table) => Some(table.entry(last).or_insert(Value::Float(f64::NAN))),
        _ => None,
    }
}

/// The largest value of a series of rows of time and value; none where it is no such series.
pub fn largest(series: &Value) -> Option<f64> {
    let values = series.as_array()?.iter().map(|row| as_number(row.as_array()?.get(1)?));
    values.collect::<Option<Vec<f64>>>()?.into_iter().reduce(f64::max)
}

/// Size of a series, to compare it with a multiple of it.
pub fn size(series: &Series) -> f64 {
    match series {
        Series::Constant(value) => *value,
        Series::Table(rows) => rows.iter().map(|row| row[1]).fold(0.0, f64::max),
        Series::File { factor, .. } => *factor,
    }
}

/// The size of a series or a factor as it is written in a scene.
pub fn size_as_written(value: &str) -> Option<f64> {
    let value = format!("v = {value}").parse::<Table>().ok()?.remove("v")?;
    as_number(&value).or_else(|| largest(&value))
}

/// A series of rows of time and value with its values multiplied, as it is written in a scene.
pub fn multiplied(series: &Value, times: f64) -> Option<String> {
    let row = |row: &Value| {
        let [time, value] = row.as_array()?.as_slice() else { return None };
        Some(Value::Array(vec![Value::Float(as_number(time)?), Value::Float(times * as_number(value)?)]))
    };
    Some(Value::Array(series.as_array()?.iter().map(row).collect::<Option<_>>()?).to_string())
}
