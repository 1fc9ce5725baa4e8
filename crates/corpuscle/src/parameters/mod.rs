//! Parameters of a scene: values that a user may change, each with its range and its unit.

mod values;

use crate::{Error, LiveChange, Simulation};
use corpuscle_model::ModelError;
use corpuscle_scene::{Scene, Series};
use toml::{Table, Value};
use values::place_at;
pub use values::{as_number, largest, multiplied, set, size, size_as_written, value_at};

/// A change of a scene that runs.
pub type Change = Box<dyn FnOnce(&mut Simulation) -> Result<(), Error> + Send>;

/// A change of a model that runs.
pub fn live(change: impl Into<LiveChange> + Send + 'static) -> Option<Change> {
    Some(Box::new(move |simulation| simulation.change_live(change)))
}

/// The number in a key, as in `flood.inflow.0.discharge_m3_per_s`.
pub fn number_in(path: &str) -> Option<usize> {
    path.split('.').find_map(|word| word.parse().ok())
}

/// Asks for the number that another parameter has now, by its key.
pub type Numbers<'a> = &'a dyn Fn(&str) -> Option<f64>;

/// Changes a value while the scene goes on: by its key, as it is written, and what the others are; none where that cannot be told.
pub type Live = fn(&str, &str, Numbers<'_>) -> Option<Change>;

/// A value of the scene that can be changed.
pub struct Parameter {
    /// Its key, as on the command line.
    pub path: String,
    /// What it is called here.
    pub name: String,
    /// What it means.
    pub hint: &'static str,
    /// Its unit; empty for a number.
    pub unit: &'static str,
    /// What it is changed with.
    pub control: Control,
    /// Changes it while the scene goes on; none where a restart takes it.
    pub live: Option<Live>,
}

/// What a value is changed with.
pub enum Control {
    /// A number in a range.
    Number {
        /// The smallest and the largest.
        range: [f64; 2],
        /// True where a step is a factor.
        logarithmic: bool,
    },
    /// A whole number in a range.
    Whole([f64; 2]),
    /// By how many times the values of a series are multiplied, in a range.
    Times([f64; 2]),
    /// One of several: what they are called, and as they are written in the scene.
    Choice(&'static [(&'static str, &'static str)]),
}

/// Parameters under a heading.
pub struct Group {
    /// The heading.
    pub name: String,
    /// The parameters.
    pub parameters: Vec<Parameter>,
}

/// How many times more a slider gives of what the scene says.
pub const MOST_TIMES: f64 = 5.0;

/// Groups as they are put together; what the scene does not have is left out.
pub struct Builder {
    /// The scene as written, with all defaults, and the values of keys that it leaves out and that are offered.
    pub document: Table,
    /// The groups.
    pub groups: Vec<Group>,
    /// Keys that the scene leaves out.
    pub left_out: Vec<String>,
}

impl Builder {
    /// Begins a group: what follows stands under this heading.
    pub fn group(&mut self, name: impl Into<String>) -> &mut Self {
        self.groups.push(Group { name: name.into(), parameters: Vec::new() });
        self
    }

    /// A parameter; left out where the scene has no such value.
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

    /// A number above 0 from a tenth of what it is to ten times as much.
    pub fn scaled(&mut self, path: impl Into<String>, name: &str, unit: &'static str, hint: &'static str) -> &mut Self {
        self.between(path, name, unit, [0.1, 10.0], hint)
    }

    /// A number above 0 in a range that is told in parts of what it is.
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

    /// A value that the scene may leave out: it is then this.
    pub fn or(&mut self, path: &str, value: f64) -> &mut Self {
        if let Some(place) = place_at(&mut self.document, path) {
            *place = Value::Float(value);
            self.left_out.push(path.into());
        }
        self
    }

    /// The last one changes while the scene goes on.
    pub fn live(&mut self, path: &str, change: Live) -> &mut Self {
        let last = self.groups.last_mut().and_then(|group| group.parameters.last_mut());
        if let Some(last) = last.filter(|last| last.path == path) {
            last.live = Some(change);
        }
        self
    }
}

impl Builder {
    /// All numbers of a table, each from a tenth of what it is to ten times as much: for a model that says nothing else.
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

/// Paths of the numbers below a value, whether they are whole, and what they are.
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

/// What can be changed in a scene as it is written; `now` is the scene with the changes that it goes on with.
///
/// # Errors
/// [`ModelError::Setup`] where the scene is of a model that was not registered.
pub fn parameters(scene: &Scene, now: &Scene, document: Table) -> Result<Builder, ModelError> {
    let mut builder = Builder { document, groups: Vec::new(), left_out: Vec::new() };
    crate::models::of(scene)?.parameters(&mut builder, scene, now);
    let whole = Control::Whole([0.0, 99.0]);
    builder.group("Run").scaled("run.until_s", "End", "s", "When the scene ends").add(
        "seed",
        "Seed",
        "",
        "Another seed, another start by chance",
        whole,
    );
    builder.groups.retain(|group| !group.parameters.is_empty());
    Ok(builder)
}
