//! Parameters of a scene: values that a user may change, each with its range and its unit.

mod values;

use crate::LiveChange;
use corpuscle_scene::{Scene, Series};
use serde::{Deserialize, Serialize};
use toml::{Table, Value};
use values::slot_at;
pub use values::{as_number, largest, multiplied, set, size, size_as_written, value_at};

/// A change of a running scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Change {
    /// Live changes of its model, one after another.
    Model(Vec<LiveChange>),
    /// A gauge is placed in a flood.
    Gauge {
        /// Its name.
        name: String,
        /// Position in model coordinates.
        at: [f64; 2],
    },
}

/// A change of a model that runs.
pub fn live(change: impl Into<LiveChange>) -> Option<Change> {
    Some(Change::Model(vec![change.into()]))
}

/// The number in a key, as in `flood.inflow.0.discharge_m3_per_s`.
pub fn number_in(path: &str) -> Option<usize> {
    path.split('.').find_map(|word| word.parse().ok())
}

/// Values of a scene that runs.
pub struct Current<'a> {
    /// The scene as it was opened.
    pub scene: &'a Scene,
    /// Gives the current number of a parameter by its key.
    pub number: &'a dyn Fn(&str) -> Option<f64>,
}

/// A function that makes the live change of a value from its key, its text and the current values; none where these are unknown.
pub type Live = fn(&str, &str, &Current<'_>) -> Option<Change>;

/// A value of the scene that can be changed.
pub struct Parameter {
    /// Its key, as on the command line.
    pub path: String,
    /// Its name.
    pub name: String,
    /// Its meaning.
    pub hint: &'static str,
    /// Its unit; empty for a number.
    pub unit: &'static str,
    /// The control that changes it.
    pub control: Control,
    /// Makes its live change; none where it needs a restart.
    pub live: Option<Live>,
}

/// The control that changes a value.
pub enum Control {
    /// A number in a range.
    Number {
        /// The smallest and the largest.
        range: [f64; 2],
        /// True for a logarithmic range.
        logarithmic: bool,
    },
    /// A whole number in a range.
    Whole([f64; 2]),
    /// A factor on the values of a series, in a range.
    Times([f64; 2]),
    /// One of several: names, and values as the scene writes them.
    Choice(&'static [(&'static str, &'static str)]),
}

/// Parameters under a heading.
pub struct Group {
    /// The heading.
    pub name: String,
    /// The parameters.
    pub parameters: Vec<Parameter>,
}

/// Largest factor on the values of a series.
pub const MOST_TIMES: f64 = 5.0;

/// Builder of the groups of parameters; keys that the scene does not have are skipped.
pub struct Builder {
    /// The scene as written, with all defaults, and the default values of offered keys that it leaves out.
    pub document: Table,
    /// The groups.
    pub groups: Vec<Group>,
    /// Keys that the scene leaves out.
    pub left_out: Vec<String>,
}

impl Builder {
    /// Begins a group with this heading; the parameters added next belong to it.
    pub fn group(&mut self, name: impl Into<String>) -> &mut Self {
        self.groups.push(Group { name: name.into(), parameters: Vec::new() });
        self
    }

    /// Adds a parameter; skipped where the scene has no such value.
    pub fn add(
        &mut self,
        path: impl Into<String>,
        name: &str,
        unit: &'static str,
        hint: &'static str,
        control: Control,
    ) -> &mut Self {
        let path = path.into();
        let fits = match &control {
            Control::Choice(_) => value_at(&self.document, &path).is_some(),
            Control::Times(_) => value_at(&self.document, &path).and_then(largest).is_some_and(|most| most > 0.0),
            Control::Number { .. } | Control::Whole(_) => value_at(&self.document, &path).and_then(as_number).is_some(),
        };
        if let Some(group) = self.groups.last_mut().filter(|_| fits) {
            group.parameters.push(Parameter { path, name: name.into(), hint, unit, control, live: None });
        }
        self
    }

    /// A number in a range.
    pub fn number(
        &mut self,
        path: impl Into<String>,
        name: &str,
        unit: &'static str,
        range: [f64; 2],
        hint: &'static str,
    ) -> &mut Self {
        self.add(path, name, unit, hint, Control::Number { range, logarithmic: false })
    }

    /// Adds a positive number, from a tenth of its value to ten times it.
    pub fn scaled(&mut self, path: impl Into<String>, name: &str, unit: &'static str, hint: &'static str) -> &mut Self {
        self.between(path, name, unit, [0.1, 10.0], hint)
    }

    /// Adds a positive number in a range that is relative to its value.
    pub fn between(
        &mut self,
        path: impl Into<String>,
        name: &str,
        unit: &'static str,
        parts: [f64; 2],
        hint: &'static str,
    ) -> &mut Self {
        let path = path.into();
        match value_at(&self.document, &path).and_then(as_number).filter(|value| *value > 0.0) {
            Some(value) => {
                let range = parts.map(|part| part * value);
                self.add(path, name, unit, hint, Control::Number { range, logarithmic: true })
            }
            None => self,
        }
    }

    /// A value over time, 0 or more: a number, up to `most` where it is 0, or by how many times what the scene says is multiplied. The first way to change it is for a number, the
    /// second for a factor.
    pub fn series(
        &mut self,
        path: &str,
        name: &str,
        (unit, most): (&'static str, f64),
        hint: &'static str,
        written: &Series,
        [set, multiply]: [Live; 2],
    ) -> &mut Self {
        let times = format!("{name}, times");
        match written {
            Series::Constant(value) => {
                let most = if *value > 0.0 { MOST_TIMES * value } else { most };
                self.number(path, name, unit, [0.0, most], hint).live(path, set)
            }
            Series::Table(_) => {
                self.add(path, &times, "", hint, Control::Times([0.0, MOST_TIMES])).live(path, multiply)
            }
            Series::File { factor, .. } => {
                let path = format!("{path}.factor");
                let range = [0.0, MOST_TIMES * factor.max(0.1)];
                self.or(&path, 1.0).number(&*path, &times, "", range, hint).live(&path, multiply)
            }
        }
    }

    /// Declares the default of a key that the scene may leave out.
    pub fn or(&mut self, path: &str, value: f64) -> &mut Self {
        if let Some(slot) = slot_at(&mut self.document, path) {
            *slot = Value::Float(value);
            self.left_out.push(path.into());
        }
        self
    }

    /// Makes the last parameter live.
    pub fn live(&mut self, path: &str, change: Live) -> &mut Self {
        let last = self.groups.last_mut().and_then(|group| group.parameters.last_mut());
        if let Some(last) = last.filter(|last| last.path == path) {
            last.live = Some(change);
        }
        self
    }
}

impl Builder {
    /// Adds all numbers of a table, each from a tenth of its value to ten times it: the default of models without their own list.
    pub fn numbers_of(&mut self, table: &str) -> &mut Self {
        let mut paths = Vec::new();
        if let Some(value) = self.document.get(table) {
            numbers_below(value, table, &mut paths);
        }
        let (first, rest) = table.split_at(table.chars().next().map_or(0, char::len_utf8));
        self.group(first.to_uppercase() + rest);
        for (path, is_whole, value) in paths {
            let name = path[table.len() + 1..].replace(['.', '_'], " ");
            match is_whole {
                true => self.add(path, &name, "", "", Control::Whole([0.0, (10.0 * value).max(10.0)])),
                false => self.scaled(path, &name, "", ""),
            };
        }
        self
    }
}

/// Paths of the numbers below a value, whether they are integers, and the numbers.
fn numbers_below(value: &Value, path: &str, found: &mut Vec<(String, bool, f64)>) {
    match value {
        Value::Integer(number) => found.push((path.into(), true, *number as f64)),
        Value::Float(number) => found.push((path.into(), false, *number)),
        Value::Table(table) => {
            table.iter().for_each(|(key, value)| numbers_below(value, &format!("{path}.{key}"), found))
        }
        Value::Array(rows) => {
            rows.iter().enumerate().for_each(|(row, value)| numbers_below(value, &format!("{path}.{row}"), found));
        }
        _ => {}
    }
}
