//! Parameters of the open scene: from the scene's own keys, each with its range, its unit and its value as written.

mod slider;

use crate::icons::{self, Icon};
use corpuscle::models::parameters;
use corpuscle::parameters::{
    Builder, Change, Control, Current, Group, Parameter, as_number, largest, multiplied, set, value_at,
};
use corpuscle::scene::Scene;
use egui::{Align, ComboBox, Layout, RichText, Ui, WidgetInfo};
use slider::{is_long, slider, written};
use toml::{Table, Value};

/// Names of the gauges that changes of a scene add.
fn placed(changes: &[(String, String)]) -> Vec<String> {
    let gauges = changes.iter().filter(|(path, _)| path.starts_with("flood.gauge."));
    let name = |text: &String| {
        let row = format!("v = {text}").parse::<Table>().ok()?;
        Some(row.get("v")?.get("name")?.as_str()?.to_owned())
    };
    gauges.filter_map(|(_, text)| name(text)).collect()
}

/// The parameters of the open scene.
pub struct Parameters {
    groups: Vec<Group>,
    /// The scene as written, without changes.
    written: Table,
    /// Keys that it leaves out; their values are the defaults.
    left_out: Vec<String>,
    /// Changes: paths of values, and the values as they are written.
    changes: Vec<(String, String)>,
    /// Names of gauges that were placed.
    placed: Vec<String>,
    /// Changes that have been applied; the others wait for a restart.
    applied: Vec<(String, String)>,
}

/// A change of the parameters by the user.
pub enum Changed {
    /// A live change.
    Live(Change),
    /// Restart the scene with the changes.
    Restart,
}

impl Parameters {
    /// The parameters of a scene: `written` without the changes, `now` with them.
    pub fn new(written: &Scene, now: &Scene, changes: Vec<(String, String)>) -> Self {
        let mut whole = written.clone();
        whole.resolve_defaults();
        let document: Table = whole.to_toml().ok().and_then(|text| text.parse().ok()).unwrap_or_default();
        let Ok(Builder { groups, document: written, left_out }) = parameters(&whole, now, document) else {
            return Self::none();
        };
        Self { groups, written, left_out, placed: placed(&changes), applied: changes.clone(), changes }
    }

    /// None.
    pub fn none() -> Self {
        Self {
            groups: Vec::new(),
            written: Table::new(),
            left_out: Vec::new(),
            placed: Vec::new(),
            changes: Vec::new(),
            applied: Vec::new(),
        }
    }

    /// All changes.
    pub fn changes(&self) -> &[(String, String)] {
        &self.changes
    }

    /// Adds a gauge at a position in the terrain's own coordinates as an applied change; returns its name.
    pub fn add_gauge(&mut self, [x, y]: [f64; 2]) -> String {
        let rows = value_at(&self.written, "flood.gauge").and_then(Value::as_array);
        let names: Vec<String> = rows
            .into_iter()
            .flatten()
            .filter_map(|row| Some(row.get("name")?.as_str()?.to_owned()))
            .chain(self.placed.iter().cloned())
            .collect();
        let number = names.len();
        let name = (1..).map(|number| format!("P{number}")).find(|name| !names.contains(name)).unwrap_or_default();
        let path = format!("flood.gauge.{number}");
        let row = format!("{{ name = \"{name}\", at = [{x:?}, {y:?}] }}");
        self.changes.push((path.clone(), row.clone()));
        self.applied.push((path, row));
        self.placed.push(name.clone());
        name
    }

    /// True where changes wait for a restart.
    pub fn waits(&self) -> bool {
        self.changes != self.applied
    }

    /// Shows the parameters of a scene that runs; returns the changes made.
    pub fn ui(&mut self, ui: &mut Ui, scene: &Scene) -> Vec<Changed> {
        let mut done = Vec::new();
        let groups = std::mem::take(&mut self.groups);
        for group in &groups {
            ui.add_space(8.0);
            ui.label(RichText::new(&group.name).text_style(egui::TextStyle::Name(crate::style::STRONG.into())));
            for parameter in &group.parameters {
                if let Some(value) = self.row(ui, parameter) {
                    self.set(&parameter.path, value.clone());
                    let current = Current { scene, number: &|path| self.number_at(path) };
                    if let Some(change) = parameter.live.and_then(|live| live(&parameter.path, &value, &current)) {
                        let written = self.change_of(&parameter.path);
                        set(&mut self.applied, &parameter.path, written);
                        done.push(Changed::Live(change));
                    }
                }
            }
        }
        self.groups = groups;
        done
    }

    /// Shows the buttons for waiting changes; returns a restart where it was chosen.
    pub fn waiting(&mut self, ui: &mut Ui) -> Option<Changed> {
        if !self.waits() {
            return None;
        }
        let mut restart = false;
        ui.horizontal(|ui| {
            let accent = ui.visuals().selection.bg_fill;
            let text = RichText::new("Restart with changes").color(ui.visuals().selection.stroke.color);
            restart = ui.add(egui::Button::new(text).fill(accent)).on_hover_text("R").clicked();
            if ui.button("Undo").on_hover_text("Discard the changes that wait for a restart").clicked() {
                self.changes = self.applied.clone();
            }
        });
        restart.then_some(Changed::Restart)
    }

    fn change_of(&self, path: &str) -> Option<String> {
        self.changes.iter().find(|(changed, _)| changed == path).map(|(_, value)| value.clone())
    }

    fn set(&mut self, path: &str, value: String) {
        let written = value_at(&self.written, path).map(ToString::to_string);
        let same = written.as_deref() == Some(&value)
            || written.and_then(|written| written.parse::<f64>().ok()).is_some_and(|w| value.parse() == Ok(w));
        set(&mut self.changes, path, (!same).then_some(value));
    }

    /// The value now, as it is written in a scene.
    fn value(&self, path: &str) -> Option<Value> {
        match self.change_of(path) {
            Some(value) => format!("v = {value}").parse::<Table>().ok()?.remove("v"),
            None => value_at(&self.written, path).cloned(),
        }
    }

    /// The number at a key, from the changes or the scene.
    fn number_at(&self, path: &str) -> Option<f64> {
        let left_out = self.left_out.iter().any(|left_out| left_out == path) && self.change_of(path).is_none();
        self.value(path).filter(|_| !left_out).as_ref().and_then(as_number)
    }

    /// Shows one parameter; returns its value where it was changed.
    fn row(&self, ui: &mut Ui, parameter: &Parameter) -> Option<String> {
        let value = self.value(&parameter.path)?;
        let changed = self.change_of(&parameter.path).is_some();
        let mut new = None;
        let when = if parameter.live.is_some() { "changes at once" } else { "changes on restart" };
        let hint = format!("{}\n{} ({when})", parameter.hint, parameter.path);
        ui.horizontal(|ui| {
            let name = match is_long(parameter.unit) {
                true => format!("{}, {}", parameter.name, parameter.unit),
                false => parameter.name.clone(),
            };
            ui.label(name).on_hover_text(&hint);
            let note = if parameter.live.is_some() { "live" } else { "" };
            ui.label(RichText::new(note).small().color(crate::style::accent(ui.visuals())));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let name = format!("Reset {}", parameter.name);
                if changed && icons::sized(ui, Icon::Undo, &name, "as written", 20.0, false).clicked() {
                    new = value_at(&self.written, &parameter.path).map(ToString::to_string);
                }
            });
        });
        let label = format!("{}, {}", parameter.name, parameter.unit);
        match &parameter.control {
            Control::Choice(choices) => {
                let now = value.to_string();
                let name = choices.iter().find(|(_, written)| *written == now).map_or("other", |(name, _)| *name);
                let combo =
                    ComboBox::from_id_salt(&parameter.path).selected_text(name).width(ui.available_width() - 4.0);
                let shown = combo.show_ui(ui, |ui| {
                    for (name, written) in *choices {
                        if ui.selectable_label(now == *written, *name).clicked() {
                            new = Some((*written).to_owned());
                        }
                    }
                });
                shown.response.widget_info(|| WidgetInfo::labeled(egui::Role::ComboBox, true, &parameter.name));
            }
            Control::Number { range, logarithmic } => {
                let mut number = as_number(&value)?;
                if slider(ui, &mut number, *range, *logarithmic, false, parameter.unit, &label) {
                    new = Some(written(number));
                }
            }
            Control::Times(range) => {
                let series = value_at(&self.written, &parameter.path)?;
                let mut times = largest(&value)? / largest(series)?;
                if slider(ui, &mut times, *range, false, false, "×", &label) {
                    new = multiplied(series, times);
                }
            }
            Control::Whole(range) => {
                let mut number = as_number(&value)?;
                if slider(ui, &mut number, *range, range[1] > 1000.0, true, parameter.unit, &label) {
                    new = Some(format!("{number:.0}"));
                }
            }
        }
        new
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Source;
    use corpuscle::scene::scenes;

    /// Every value that is offered can be set through its path, to the ends of its range or another choice.
    #[test]
    fn every_parameter_of_every_scene_can_be_changed() {
        let mut refused = Vec::new();
        for builtin in scenes() {
            let scene = Scene::parse(builtin.text, builtin.name, &[]).unwrap();
            let parameters = Parameters::new(&scene, &scene, Vec::new());
            let all: Vec<_> = parameters.groups.iter().flat_map(|group| &group.parameters).collect();
            assert!(all.len() >= 4, "{}: {}", builtin.name, all.len());
            for parameter in all {
                let values = match &parameter.control {
                    Control::Number { range, .. } => range.map(written).to_vec(),
                    Control::Times(range) => {
                        let series = value_at(&parameters.written, &parameter.path).unwrap();
                        range.map(|times| multiplied(series, times).unwrap()).to_vec()
                    }
                    Control::Whole(range) => range.map(|number| format!("{number:.0}")).to_vec(),
                    Control::Choice(choices) => choices.iter().map(|(_, written)| (*written).to_owned()).collect(),
                };
                for value in values {
                    let changes = vec![(parameter.path.clone(), value.clone())];
                    let changed = Source { changes, ..Source::from(builtin) }.scene();
                    if let Err(error) = changed {
                        refused.push(format!("{} {} = {value}: {error}", builtin.name, parameter.path));
                    }
                }
            }
        }
        assert!(refused.is_empty(), "{}", refused.join("\n"));
    }

    #[test]
    fn a_change_that_is_taken_back_is_none() {
        let builtin = corpuscle::scene::builtin("gas/maxwell").unwrap();
        let scene = Scene::parse(builtin.text, builtin.name, &[]).unwrap();
        let mut parameters = Parameters::new(&scene, &scene, Vec::new());
        parameters.set("gas.restitution", "0.9".into());
        assert_eq!(parameters.changes(), [("gas.restitution".to_owned(), "0.9".to_owned())]);
        assert!(parameters.waits());
        parameters.set("gas.restitution", "1.0".into());
        assert!(parameters.changes().is_empty() && !parameters.waits());
    }
}
