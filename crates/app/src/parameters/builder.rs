//! What can be changed in a scene: its values, each with its range and its unit.

use super::values::{as_number, largest, place_at, value_at};
use super::{dew, flood, gas};
use crate::physics::Change;
use corpuscle::scene::{ModelScene, Scene, Series};
use toml::{Table, Value};

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
pub(super) const MOST_TIMES: f64 = 5.0;

/// Groups as they are put together; what the scene does not have is left out.
pub(super) struct Builder {
    /// The scene as written, with all defaults, and the values of keys that it leaves out and that are offered.
    pub(super) document: Table,
    pub(super) groups: Vec<Group>,
    /// Keys that the scene leaves out.
    pub(super) left_out: Vec<String>,
}

impl Builder {
    pub(super) fn group(&mut self, name: impl Into<String>) -> &mut Self {
        self.groups.push(Group { name: name.into(), parameters: Vec::new() });
        self
    }

    pub(super) fn add(
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

    pub(super) fn number(
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
    pub(super) fn scaled(
        &mut self,
        path: impl Into<String>,
        name: &str,
        unit: &'static str,
        hint: &'static str,
    ) -> &mut Self {
        self.between(path, name, unit, [0.1, 10.0], hint)
    }

    /// A number above 0 in a range that is told in parts of what it is.
    pub(super) fn between(
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
    pub(super) fn series(
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
    pub(super) fn or(&mut self, path: &str, value: f64) -> &mut Self {
        if let Some(place) = place_at(&mut self.document, path) {
            *place = Value::Float(value);
            self.left_out.push(path.into());
        }
        self
    }

    /// The last one changes while the scene goes on.
    pub(super) fn live(&mut self, path: &str, change: Live) -> &mut Self {
        let last = self.groups.last_mut().and_then(|group| group.parameters.last_mut());
        if let Some(last) = last.filter(|last| last.path == path) {
            last.live = Some(change);
        }
        self
    }
}

/// What can be changed in a scene as it is written; `now` is the scene with the changes that it goes on with.
pub(super) fn groups(scene: &Scene, now: &Scene, document: Table) -> Builder {
    let mut builder = Builder { document, groups: Vec::new(), left_out: Vec::new() };
    match (&scene.model, &now.model) {
        (ModelScene::Gas(gas), _) => gas::parameters(&mut builder, gas),
        (ModelScene::Flood(flood), ModelScene::Flood(now)) => {
            flood::parameters(&mut builder, &flood.flood, &now.flood);
        }
        (ModelScene::Dew(dew), _) => dew::parameters(&mut builder, dew),
        (ModelScene::Flood(_), _) => {}
    }
    let whole = Control::Whole([0.0, 99.0]);
    builder.group("Run").scaled("run.until_s", "End", "s", "When the scene ends").add(
        "seed",
        "Seed",
        "",
        "Another seed, another start by chance",
        whole,
    );
    builder.groups.retain(|group| !group.parameters.is_empty());
    builder
}
